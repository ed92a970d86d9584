#include "segmenter/io/points/file_cloud.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>

namespace kintsugi::segmenter {
namespace {

class CloudMaker {
 public:
  CloudMaker(const PointTable& table, const PointRoles& roles, const PositionFrame& frame,
             const std::string& name)
      : table_(table), roles_(roles), frame_(frame), name_(name) {
    if (roles.color) integer_color_max_ = find_color_max();
  }

  FileCloud make() const {
    FileCloud cloud;
    cloud.has_normals = roles_.normal.has_value();
    cloud.comments = table_.comments;
    cloud.points_W.reserve(table_.size());
    for (std::size_t i = 0; i < table_.size(); ++i) cloud.points_W.push_back(point(i));
    take_ids("slice_id", roles_.slice_id, cloud.slice_ids);
    take_ids("segment_id", roles_.segment_id, cloud.segment_ids);
    take_ids("instance_id", roles_.instance_id, cloud.instance_ids);
    take_ids("in_volume", roles_.in_volume, cloud.in_volume, std::uint8_t{1});
    return cloud;
  }

 private:
  [[noreturn]] void fail_at(std::size_t point, const std::string& property, double value,
                            const std::string& expected) const {
    throw std::runtime_error(name_ + ": vertex " + std::to_string(point) + ": property '" +
                             property + "' is " + std::to_string(value) + ", expected " + expected);
  }

  /// The integer that stands for full colour. 8-bit colours are often stored in 16 bits.
  double find_color_max() const {
    constexpr double kMax8Bits = 255.0;
    for (const std::size_t field : *roles_.color) {
      if (table_.fields()[field].type != ScalarType::kUint16) continue;
      for (std::size_t i = 0; i < table_.size(); ++i) {
        if (table_.value(i, field) > kMax8Bits) return std::numeric_limits<std::uint16_t>::max();
      }
    }
    return kMax8Bits;
  }

  CloudPoint point(std::size_t i) const {
    CloudPoint point;
    const auto coordinate = [&](std::size_t axis) {
      return to_float(frame_.metres_per_unit * table_.value(i, roles_.position[axis]) -
                      frame_.origin_W[static_cast<Eigen::Index>(axis)]);
    };
    point.x = coordinate(0);
    point.y = coordinate(1);
    point.z = coordinate(2);
    if (roles_.normal) {
      point.nx = to_float(table_.value(i, (*roles_.normal)[0]));
      point.ny = to_float(table_.value(i, (*roles_.normal)[1]));
      point.nz = to_float(table_.value(i, (*roles_.normal)[2]));
    }
    if (roles_.color) {
      point.red = color_value(i, (*roles_.color)[0]);
      point.green = color_value(i, (*roles_.color)[1]);
      point.blue = color_value(i, (*roles_.color)[2]);
    }
    if (roles_.weight) point.weight = to_float(table_.value(i, *roles_.weight));
    return point;
  }

  std::uint8_t color_value(std::size_t i, std::size_t field) const {
    const double value = table_.value(i, field);
    const double max = is_integer(table_.fields()[field].type) ? integer_color_max_ : 1.0;
    if (!(value >= 0.0 && value <= max)) {
      fail_at(i, table_.fields()[field].name, value,
              "0 to " + std::to_string(static_cast<int>(max)));
    }
    return static_cast<std::uint8_t>(std::lround(value * (255.0 / max)));
  }

  template <typename Id>
  void take_ids(const std::string& property, std::optional<std::size_t> field, std::vector<Id>& ids,
                Id max = std::numeric_limits<Id>::max()) const {
    if (!field) return;
    ids.reserve(table_.size());
    for (std::size_t i = 0; i < table_.size(); ++i) {
      const double value = table_.value(i, *field);
      if (!(value >= 0.0 && value <= static_cast<double>(max) && value == std::floor(value))) {
        fail_at(i, property, value, "a whole number from 0 to " + std::to_string(max));
      }
      ids.push_back(static_cast<Id>(value));
    }
  }

  const PointTable& table_;
  const PointRoles& roles_;
  const PositionFrame& frame_;
  const std::string& name_;
  double integer_color_max_ = 0.0;
};

/// Of at most 100,000 finite values that are evenly spread over the table; 0 without any.
double median(const PointTable& table, std::size_t field) {
  constexpr std::size_t kMaxSamples = 100'000;
  const std::size_t stride = table.size() / kMaxSamples + 1;
  std::vector<double> samples;
  samples.reserve(table.size() / stride + 1);
  for (std::size_t i = 0; i < table.size(); i += stride) {
    const double value = table.value(i, field);
    if (std::isfinite(value)) samples.push_back(value);
  }
  if (samples.empty()) return 0.0;
  const auto middle = samples.begin() + static_cast<std::ptrdiff_t>(samples.size() / 2);
  std::nth_element(samples.begin(), middle, samples.end());
  return *middle;
}

}  // namespace

Eigen::Vector3d choose_origin_W(const PointTable& table, const PointRoles& roles,
                                double metres_per_unit) {
  constexpr double kFar_m = 1e3;
  constexpr double kNoPlace_m = 1e8;
  constexpr double kStep_m = 100.0;
  Eigen::Vector3d origin_W = Eigen::Vector3d::Zero();
  bool is_far = false;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double median_m =
        metres_per_unit * median(table, roles.position[static_cast<std::size_t>(axis)]);
    if (std::abs(median_m) > kNoPlace_m) continue;
    is_far = is_far || std::abs(median_m) > kFar_m;
    origin_W[axis] = kStep_m * std::round(median_m / kStep_m);
  }
  if (!is_far) return Eigen::Vector3d::Zero();
  return origin_W + Eigen::Vector3d::Zero();  // 0, not -0
}

FileCloud cloud_of(const PointTable& table, const PointRoles& roles, const PositionFrame& frame,
                   const std::string& name) {
  return CloudMaker(table, roles, frame, name).make();
}

}  // namespace kintsugi::segmenter
