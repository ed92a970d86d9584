#include "segmenter/map/segment_statistics.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace kintsugi::segmenter {
namespace {

constexpr double kUnits = 1099511627776.0;  // 2^40

// Below 2^63: a coordinate is below 2^20 m (admission.hpp).
std::int64_t to_units(float value) { return std::llround(static_cast<double>(value) * kUnits); }

std::array<float, 3> position(const CloudPoint& point) { return {point.x, point.y, point.z}; }

}  // namespace

SegmentStatisticsTable::Extent SegmentStatisticsTable::Extent::none() {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  return {{kInfinity, kInfinity, kInfinity},
          {-kInfinity, -kInfinity, -kInfinity},
          std::numeric_limits<std::int32_t>::max(),
          std::numeric_limits<std::int32_t>::min()};
}

void SegmentStatisticsTable::Extent::include(const CloudPoint& point, std::int32_t slice_id) {
  const auto p_W = position(point);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    min_W[axis] = std::min(min_W[axis], p_W[axis]);
    max_W[axis] = std::max(max_W[axis], p_W[axis]);
  }
  first_slice = std::min(first_slice, slice_id);
  last_slice = std::max(last_slice, slice_id);
}

bool SegmentStatisticsTable::Extent::touches(const CloudPoint& point, std::int32_t slice_id) const {
  const auto p_W = position(point);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (p_W[axis] <= min_W[axis] || p_W[axis] >= max_W[axis]) {
      return true;
    }
  }
  return slice_id == first_slice || slice_id == last_slice;
}

void SegmentStatisticsTable::Sums::add(const CloudPoint& point, std::int64_t sign) {
  num_points += sign;
  const std::array<float, 3> normal_W{point.nx, point.ny, point.nz};
  const std::array<std::int64_t, 3> rgb{point.red, point.green, point.blue};
  const auto p_W = segmenter::position(point);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::int64_t signed_position = sign * to_units(p_W[axis]);
    const std::int64_t signed_normal = sign * to_units(normal_W[axis]);
    position[axis] += signed_position;
    normal[axis] += signed_normal;
    color[axis] += sign * rgb[axis];
  }
}

std::vector<std::uint32_t> SegmentStatisticsTable::apply(const PointCloud& cloud,
                                                         const SegmentIds& ids,
                                                         const std::vector<IdChange>& changes) {
  sums_.resize(ids.next_id());
  std::vector<std::uint32_t> touched;
  for (const IdChange& change : changes) {
    const CloudPoint& point = cloud[change.point];
    const std::int32_t slice_id = cloud.slice_of(change.point).slice_id;
    if (change.old_id != kNoSegment) {
      Sums& old = sums_[change.old_id];
      old.add(point, -1);
      old.extent_is_stale = old.extent_is_stale || old.extent.touches(point, slice_id);
      touched.push_back(change.old_id);
    }
    if (change.new_id != kNoSegment) {
      Sums& heir = sums_[change.new_id];
      heir.add(point, 1);
      heir.extent.include(point, slice_id);
      touched.push_back(change.new_id);
    }
  }

  std::sort(touched.begin(), touched.end());
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
  for (const std::uint32_t id : touched) {
    if (sums_[id].extent_is_stale) {
      rebuild_extent(cloud, ids, id);
    }
  }
  std::erase_if(touched, [&](std::uint32_t id) { return sums_[id].num_points == 0; });
  return touched;
}

void SegmentStatisticsTable::rebuild_extent(const PointCloud& cloud, const SegmentIds& ids,
                                            std::uint32_t segment_id) {
  Sums& sums = sums_[segment_id];
  sums.extent = Extent::none();
  sums.extent_is_stale = false;
  for (const PointIndex point : ids.points_of(segment_id)) {
    sums.extent.include(cloud[point], cloud.slice_of(point).slice_id);
  }
}

SegmentStatistics SegmentStatisticsTable::operator()(std::uint32_t segment_id) const {
  const Sums& sums = sums_.at(segment_id);
  assert(sums.num_points > 0);
  const auto count = static_cast<double>(sums.num_points);
  SegmentStatistics result;
  result.segment_id = segment_id;
  result.num_points = static_cast<std::uint32_t>(sums.num_points);

  std::array<double, 3> mean_normal{};
  double squared_length = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    mean_normal[axis] = static_cast<double>(sums.normal[axis]) / (kUnits * count);
    squared_length += mean_normal[axis] * mean_normal[axis];
  }
  constexpr double kMinLength = 1e-6;  // below it rounding decides the direction
  const double length = std::sqrt(squared_length);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    result.box_min_W[axis] = sums.extent.min_W[axis];
    result.box_max_W[axis] = sums.extent.max_W[axis];
    result.centroid_W[axis] =
        static_cast<float>(static_cast<double>(sums.position[axis]) / (kUnits * count));
    result.mean_normal_W[axis] =
        length < kMinLength ? 0.0F : static_cast<float>(mean_normal[axis] / length);
    result.mean_color[axis] =
        static_cast<std::uint8_t>(std::lround(static_cast<double>(sums.color[axis]) / count));
  }
  result.area_m2 = static_cast<float>(count * resolution_m_ * resolution_m_);
  result.first_slice = sums.extent.first_slice;
  result.last_slice = sums.extent.last_slice;
  return result;
}

std::vector<SegmentStatistics> SegmentStatisticsTable::all() const {
  std::vector<SegmentStatistics> result;
  for (std::size_t id = 0; id < sums_.size(); ++id) {
    if (sums_[id].num_points > 0) {
      result.push_back((*this)(static_cast<std::uint32_t>(id)));
    }
  }
  return result;
}

}  // namespace kintsugi::segmenter
