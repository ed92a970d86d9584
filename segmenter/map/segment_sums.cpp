#include "segmenter/map/segment_sums.hpp"

#include <cassert>
#include <cmath>

namespace kintsugi::segmenter {
namespace {

constexpr double kUnits = 1099511627776.0;  // 2^40

// Below 2^63: a coordinate is below 2^20 m (admission.hpp). Rounds as std::llround(), which is a
// call: the sum is exact where there is a fraction, since a float32 has 24 bits.
std::int64_t to_units(float value) {
  const double units = static_cast<double>(value) * kUnits;
  return static_cast<std::int64_t>(units + std::copysign(0.5, units));
}

}  // namespace

void SegmentSums::add(const CloudPoint& point, bool is_in_volume, std::int64_t sign) {
  num_points += sign;
  if (is_in_volume) num_in_volume += sign;
  const std::array<float, 3> normal_W{point.nx, point.ny, point.nz};
  const std::array<std::int64_t, 3> rgb{point.red, point.green, point.blue};
  const std::array<float, 3> p_W{point.x, point.y, point.z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::int64_t signed_position = sign * to_units(p_W[axis]);
    const std::int64_t signed_normal = sign * to_units(normal_W[axis]);
    position[axis] += signed_position;
    normal[axis] += signed_normal;
    color[axis] += sign * rgb[axis];
  }
}

void SegmentSums::add(const SegmentSums& other) {
  num_points += other.num_points;
  num_in_volume += other.num_in_volume;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    position[axis] += other.position[axis];
    normal[axis] += other.normal[axis];
    color[axis] += other.color[axis];
  }
  extent.include(other.extent);
}

SegmentStatistics SegmentSums::statistics(std::uint32_t segment_id, float resolution_m) const {
  assert(num_points > 0);
  const auto count = static_cast<double>(num_points);
  SegmentStatistics result;
  result.segment_id = segment_id;
  result.num_points = static_cast<std::uint32_t>(num_points);

  std::array<double, 3> mean_normal{};
  double squared_length = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    mean_normal[axis] = static_cast<double>(normal[axis]) / (kUnits * count);
    squared_length += mean_normal[axis] * mean_normal[axis];
  }
  constexpr double kMinLength = 1e-6;  // below it rounding decides the direction
  const double length = std::sqrt(squared_length);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    result.box_min_W[axis] = extent.min_W[axis];
    result.box_max_W[axis] = extent.max_W[axis];
    result.centroid_W[axis] =
        static_cast<float>(static_cast<double>(position[axis]) / (kUnits * count));
    result.mean_normal_W[axis] =
        length < kMinLength ? 0.0F : static_cast<float>(mean_normal[axis] / length);
    result.mean_color[axis] =
        static_cast<std::uint8_t>(std::lround(static_cast<double>(color[axis]) / count));
  }
  result.area_m2 = static_cast<float>(count * resolution_m * resolution_m);
  result.first_slice = extent.first_slice;
  result.last_slice = extent.last_slice;
  result.points_in_volume = static_cast<std::uint32_t>(num_in_volume);
  return result;
}

}  // namespace kintsugi::segmenter
