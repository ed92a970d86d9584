#include "segmenter/core/point_cloud.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

#include "segmenter/core/admission.hpp"

namespace kintsugi::segmenter {

const SliceRecord& PointCloud::add_slice(std::int32_t slice_id,
                                         std::span<const CloudPoint> points_W) {
  if (slice_id < 0) {
    throw std::invalid_argument("slice_id is " + std::to_string(slice_id) + ", must be >= 0");
  }
  const bool present = std::any_of(slices_.begin(), slices_.end(),
                                   [&](const SliceRecord& s) { return s.slice_id == slice_id; });
  if (present) {
    throw std::invalid_argument("slice_id " + std::to_string(slice_id) +
                                " is in the cloud already");
  }
  // LabelRun addresses a point in its slice by an int32.
  constexpr auto kMaxSlicePoints = std::numeric_limits<std::int32_t>::max();
  constexpr auto kMaxPoints = std::numeric_limits<PointIndex>::max() - 1;
  if (points_W.size() > kMaxSlicePoints || points_W.size() > kMaxPoints - points_W_.size()) {
    throw std::length_error("slice " + std::to_string(slice_id) + " of " +
                            std::to_string(points_W.size()) +
                            " points: the cloud would outgrow its 32-bit indices");
  }

  SliceRecord slice;
  slice.slice_id = slice_id;
  slice.num_points = static_cast<std::int32_t>(points_W.size());
  slice.first = size();
  for (std::size_t index = 0; index < points_W.size(); ++index) {
    if (!reason_to_reject(points_W[index])) {
      change_.added.push_back(size());
      points_W_.push_back(points_W[index]);
    } else {
      slice.rejected.push_back(static_cast<std::int32_t>(index));
    }
  }
  slice.count = size() - slice.first;
  num_rejected_ += static_cast<std::int64_t>(slice.rejected.size());
  return slices_.emplace_back(std::move(slice));
}

CloudChange PointCloud::everything() const {
  CloudChange change;
  change.added.resize(size());
  std::iota(change.added.begin(), change.added.end(), PointIndex{0});
  return change;
}

const SliceRecord& PointCloud::slice_of(PointIndex i) const {
  const auto after =
      std::upper_bound(slices_.begin(), slices_.end(), i,
                       [](PointIndex point, const SliceRecord& s) { return point < s.first; });
  return *std::prev(after);  // an empty slice comes before the next one with the same first
}

PointId PointCloud::id_of(PointIndex i) const {
  const SliceRecord& slice = slice_of(i);
  const auto accepted_before = static_cast<std::int32_t>(i - slice.first);
  // Rejected point k of the slice has rejected[k] - k accepted points before it.
  const auto after = std::partition_point(
      slice.rejected.begin(), slice.rejected.end(), [&](const std::int32_t& rejected) {
        return rejected - (&rejected - slice.rejected.data()) <= accepted_before;
      });
  const auto rejected_before = static_cast<std::int32_t>(after - slice.rejected.begin());
  return {slice.slice_id, accepted_before + rejected_before};
}

}  // namespace kintsugi::segmenter
