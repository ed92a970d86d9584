#include "segmenter/io/labelled_cloud.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <iterator>
#include <optional>
#include <utility>

#include "lcmtypes/base/logger.hpp"
#include "lcmtypes/base/ply_writer.hpp"
#include "segmenter/io/ply/labelled_ply_writer.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr std::string_view kLabel = "segment_id";
constexpr std::array<const char*, 3> kNormal{"nx", "ny", "nz"};

/// Makes the records of the file from those of the table.
class RecordMaker {
 public:
  explicit RecordMaker(const PointTable& table) : table_(table) {
    for (const PointField& field : table.fields()) {
      if (field.is_list) {
        spdlog::warn("list '{}' of the vertices is left out", field.name);
      } else if (field.name != kLabel) {
        kept_.push_back(field);
        properties_.push_back(std::string(name_of(field.type)) + " " + field.name);
      }
    }
    has_normals_ = table.find(kNormal[0]).has_value();
    if (!has_normals_) {
      for (const char* name : kNormal) properties_.push_back(std::string("float ") + name);
    }
    properties_.push_back("int " + std::string(kLabel));
  }

  const std::vector<std::string>& properties() const { return properties_; }

  /// Valid until the next call.
  std::span<const char> make(std::size_t i, const CloudPoint& point, std::uint32_t label) {
    record_.clear();
    const std::span<const char> from = table_.record(i);
    for (const PointField& field : kept_) {
      const auto bytes = from.subspan(field.offset, size_of(field.type));
      record_.insert(record_.end(), bytes.begin(), bytes.end());
      if (const std::optional<float> component = normal_component(field.name, point)) {
        replace_last(field.type, *component);
      }
    }
    if (!has_normals_) {
      for (const float component : {point.nx, point.ny, point.nz}) append(component);
    }
    append(signed_label(label));
    return record_;
  }

 private:
  static std::optional<float> normal_component(std::string_view name, const CloudPoint& point) {
    if (name == kNormal[0]) return point.nx;
    if (name == kNormal[1]) return point.ny;
    if (name == kNormal[2]) return point.nz;
    return std::nullopt;
  }

  /// Unless it is the same as float32: then the digits of the input stay.
  void replace_last(ScalarType type, float value) {
    char* const at = record_.data() + record_.size() - size_of(type);
    if (to_float(read_scalar(at, type)) != value) write_scalar(value, type, at);
  }

  template <class T>
  void append(T value) {
    const std::size_t end = record_.size();
    record_.resize(end + sizeof value);
    std::memcpy(record_.data() + end, &value, sizeof value);
  }

  const PointTable& table_;
  std::vector<PointField> kept_;
  std::vector<std::string> properties_;
  bool has_normals_ = false;
  std::vector<char> record_;
};

/// Those of the input, without line ends, and ours; none twice.
std::vector<std::string> all_comments(const PointTable& table,
                                      const std::vector<std::string>& ours) {
  std::vector<std::string> comments = table.comments;
  for (std::string& comment : comments) std::ranges::replace(comment, '\r', ' ');
  for (const std::string& comment : ours) {
    if (std::ranges::find(comments, comment) == comments.end()) comments.push_back(comment);
  }
  return comments;
}

}  // namespace

void write_labelled_cloud(const CloudInput& input, std::span<const std::uint32_t> labels,
                          const std::vector<std::string>& comments,
                          const std::filesystem::path& path) {
  const PointTable& table = input.table;
  RecordMaker maker(table);
  std::vector<kintsugi::PlyElement> elements{{.name = "vertex",
                                              .properties = maker.properties(),
                                              .count = static_cast<std::int64_t>(table.size())}};
  for (const OtherElement& other : table.other_elements) {
    elements.push_back({.name = other.name, .properties = other.properties, .count = other.count});
  }
  PlyWriter writer(path, std::move(elements), all_comments(table, comments));
  for (std::size_t i = 0; i < table.size(); ++i) {
    writer.append_records(0, maker.make(i, input.cloud.points_W[i], labels[i]), 1);
  }
  for (std::size_t k = 0; k < table.other_elements.size(); ++k) {
    const OtherElement& other = table.other_elements[k];
    writer.append_records(k + 1, other.records, other.count);
  }
  writer.commit();
}

}  // namespace kintsugi::segmenter
