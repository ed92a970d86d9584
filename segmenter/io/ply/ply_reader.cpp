#include "segmenter/io/ply/ply_reader.hpp"

#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "segmenter/io/ply/ply_body.hpp"
#include "segmenter/io/ply/ply_header.hpp"

namespace kintsugi::segmenter {
namespace {

enum class Allowed { kReal, kInteger, kColor, kAny };

// Turns rows of element `vertex` into points.
class VertexReader {
 public:
  VertexReader(const PlyElement& vertex, const std::string& name)
      : vertex_(vertex),
        name_(name),
        position_(*find({"x", "y", "z"}, Allowed::kReal, true)),
        normal_(find({"nx", "ny", "nz"}, Allowed::kReal, false)),
        color_(find({"red", "green", "blue"}, Allowed::kColor, false)),
        weight_(find_one("weight", Allowed::kAny)),
        slice_id_(find_one("slice_id", Allowed::kInteger)),
        segment_id_(find_one("segment_id", Allowed::kInteger)),
        instance_id_(find_one("instance_id", Allowed::kInteger)),
        in_volume_(find_one("in_volume", Allowed::kInteger)) {}

  bool has_normals() const { return normal_.has_value(); }

  void append(std::int64_t row, const std::vector<double>& values, PlyCloud& cloud) const {
    CloudPoint point;
    point.x = to_float(values[position_[0]]);
    point.y = to_float(values[position_[1]]);
    point.z = to_float(values[position_[2]]);
    if (normal_) {
      point.nx = to_float(values[(*normal_)[0]]);
      point.ny = to_float(values[(*normal_)[1]]);
      point.nz = to_float(values[(*normal_)[2]]);
    }
    if (color_) {
      point.red = color_value(row, (*color_)[0], values);
      point.green = color_value(row, (*color_)[1], values);
      point.blue = color_value(row, (*color_)[2], values);
    }
    if (weight_) {
      point.weight = to_float(values[*weight_]);
    }
    cloud.points_W.push_back(point);
    if (slice_id_) {
      cloud.slice_ids.push_back(id_value<std::int32_t>(row, "slice_id", values[*slice_id_]));
    }
    if (segment_id_) {
      cloud.segment_ids.push_back(id_value<std::uint32_t>(row, "segment_id", values[*segment_id_]));
    }
    if (instance_id_) {
      cloud.instance_ids.push_back(
          id_value<std::uint32_t>(row, "instance_id", values[*instance_id_]));
    }
    if (in_volume_) {
      cloud.in_volume.push_back(id_value<std::uint8_t>(row, "in_volume", values[*in_volume_], 1));
    }
  }

 private:
  using Triple = std::array<std::size_t, 3>;

  [[noreturn]] void fail_in_header(const std::string& what) const {
    throw std::runtime_error(name_ + ": line " + std::to_string(vertex_.line) +
                             ": element 'vertex' " + what);
  }

  [[noreturn]] void fail_at(std::int64_t row, const std::string& what) const {
    throw std::runtime_error(name_ + ": vertex " + std::to_string(row) + ": " + what);
  }

  std::optional<std::size_t> find_one(std::string_view property, Allowed allowed) const {
    const auto index = vertex_.find(property);
    if (index) {
      check_type(vertex_.properties[*index], allowed);
    }
    return index;
  }

  std::optional<Triple> find(const std::array<std::string_view, 3>& names, Allowed allowed,
                             bool required) const {
    Triple triple{};
    std::size_t num_found = 0;
    std::string missing;
    for (std::size_t i = 0; i < 3; ++i) {
      if (const auto index = find_one(names[i], allowed)) {
        triple[i] = *index;
        ++num_found;
      } else {
        missing += " '" + std::string(names[i]) + "'";
      }
    }
    if (num_found == 0 && !required) {
      return std::nullopt;
    }
    if (num_found != 3) {
      fail_in_header("lacks property" + missing);
    }
    return triple;
  }

  void check_type(const PlyProperty& property, Allowed allowed) const {
    if (property.list_count) {
      fail_in_header("has a list as property '" + property.name + "', expected a scalar");
    }
    const bool is_real = !is_integer(property.type);
    if (allowed == Allowed::kReal && !is_real) {
      fail_in_type(property, "float or double");
    }
    if (allowed == Allowed::kInteger && is_real) {
      fail_in_type(property, "an integer type");
    }
    if (allowed == Allowed::kColor && !is_real && property.type != PlyType::kUint8) {
      fail_in_type(property, "uchar, or float in 0..1");
    }
  }

  [[noreturn]] void fail_in_type(const PlyProperty& property, const std::string& expected) const {
    fail_in_header("has property '" + property.name + "' of type " +
                   std::string(name_of(property.type)) + ", expected " + expected);
  }

  // A double beyond float32 becomes infinite, and is rejected as such later.
  static float to_float(double value) {
    constexpr double kMax = std::numeric_limits<float>::max();
    if (std::abs(value) > kMax) {
      return std::copysign(std::numeric_limits<float>::infinity(),
                           static_cast<float>(value > 0.0 ? 1.0 : -1.0));
    }
    return static_cast<float>(value);
  }

  std::uint8_t color_value(std::int64_t row, std::size_t index,
                           const std::vector<double>& values) const {
    const bool is_unit_range = !is_integer(vertex_.properties[index].type);
    const double max = is_unit_range ? 1.0 : 255.0;
    const double value = values[index];
    if (!(value >= 0.0 && value <= max)) {
      fail_at(row, "property '" + vertex_.properties[index].name + "' is " + std::to_string(value) +
                       ", expected 0 to " + (is_unit_range ? "1" : "255"));
    }
    return static_cast<std::uint8_t>(std::lround(value * (255.0 / max)));
  }

  template <typename Id>
  Id id_value(std::int64_t row, const std::string& property, double value,
              Id max = std::numeric_limits<Id>::max()) const {
    if (!(value >= 0.0 && value <= static_cast<double>(max) && value == std::floor(value))) {
      fail_at(row, "property '" + property + "' is " + std::to_string(value) +
                       ", expected a whole number from 0 to " + std::to_string(max));
    }
    return static_cast<Id>(value);
  }

  const PlyElement& vertex_;
  const std::string& name_;
  Triple position_;
  std::optional<Triple> normal_;
  std::optional<Triple> color_;
  std::optional<std::size_t> weight_;
  std::optional<std::size_t> slice_id_;
  std::optional<std::size_t> segment_id_;
  std::optional<std::size_t> instance_id_;
  std::optional<std::size_t> in_volume_;
};

PlyCloud read_vertices(PlyBody& body, const PlyElement& element, const std::string& name) {
  const VertexReader reader(element, name);
  body.check_count(element);
  PlyCloud cloud;
  cloud.has_normals = reader.has_normals();
  cloud.points_W.reserve(static_cast<std::size_t>(element.count));
  std::vector<double> values;
  for (std::int64_t row = 0; row < element.count; ++row) {
    body.read_row(element, row, values);
    reader.append(row, values, cloud);
  }
  return cloud;
}

}  // namespace

PlyCloud parse_ply(std::string_view bytes, const std::string& name) {
  PlyHeader header = parse_ply_header(bytes, name);
  const auto body = make_ply_body(bytes, header, name);
  std::optional<PlyCloud> cloud;
  for (const PlyElement& element : header.elements) {
    if (element.name == "vertex") {
      cloud = read_vertices(*body, element, name);
    } else {
      body->skip(element);
    }
  }
  if (!cloud) {
    throw std::runtime_error(name + ": the header declares no element 'vertex'");
  }
  body->expect_end();
  cloud->comments = std::move(header.comments);
  return std::move(*cloud);
}

PlyCloud read_ply(const std::filesystem::path& path) {
  const std::string name = path.string();
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    throw std::runtime_error(name + ": no such file");
  }
  if (!std::filesystem::is_regular_file(path, error)) {
    throw std::runtime_error(name + ": not a regular file");
  }
  std::string bytes(std::filesystem::file_size(path), '\0');
  std::ifstream file(path, std::ios::binary);
  if (!file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) {
    throw std::runtime_error(name + ": cannot be read to its end");
  }
  return parse_ply(bytes, name);
}

}  // namespace kintsugi::segmenter
