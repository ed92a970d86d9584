#include "segmenter/core/points/point_cloud.hpp"

#include <algorithm>
#include <cassert>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "segmenter/core/points/admission.hpp"
#include "segmenter/core/points/voxel_pairs.hpp"

namespace kintsugi::segmenter {
namespace {

/// Pairs the accepted points that have the same index in the slice, by ascending index.
void append_moved_by_index(const SliceRecord& before, const SliceRecord& after,
                           std::vector<MovedPoint>& moved) {
  PointIndex from = 0;
  PointIndex to = 0;
  while (from < before.count && to < after.count) {
    const std::int32_t index_before = before.index_of(from);
    const std::int32_t index_after = after.index_of(to);
    if (index_before == index_after) moved.push_back({before.first + from, after.first + to});
    from += index_before <= index_after;
    to += index_after <= index_before;
  }
}

void append_indices(const SliceRecord& slice, std::vector<PointIndex>& points) {
  for (PointIndex k = 0; k < slice.count; ++k) points.push_back(slice.first + k);
}

}  // namespace

std::int32_t SliceRecord::index_of(PointIndex k) const {
  const auto accepted_before = static_cast<std::int32_t>(k);
  // Rejected point n of the slice has rejected[n] - n accepted points before it.
  const auto after =
      std::partition_point(rejected.begin(), rejected.end(), [&](const std::int32_t& index) {
        return index - (&index - rejected.data()) <= accepted_before;
      });
  return accepted_before + static_cast<std::int32_t>(after - rejected.begin());
}

const SliceRecord& PointCloud::add_slice(std::int32_t slice_id,
                                         std::span<const CloudPoint> points_W,
                                         std::int32_t revision, PatchState patch) {
  if (slice_id < 0) {
    throw std::invalid_argument("slice_id is " + std::to_string(slice_id) + ", must be >= 0");
  }
  if (position_.contains(slice_id)) {
    throw std::invalid_argument("slice_id " + std::to_string(slice_id) +
                                " is in the cloud already");
  }
  SliceRecord record = place(slice_id, revision, patch, points_W);
  const auto position = static_cast<std::uint32_t>(slices_.size());
  slices_.emplace_back();
  position_[slice_id] = position;
  make_live(position, std::move(record));
  return slices_[position];
}

const SliceRecord& PointCloud::replace_slice(std::int32_t slice_id,
                                             std::span<const CloudPoint> points_W,
                                             std::optional<std::int32_t> revision,
                                             PatchState patch) {
  const std::uint32_t position = position_of(slice_id);
  const std::int32_t old_revision = slices_[position].revision;
  if (revision.value_or(old_revision + 1) <= old_revision) {
    throw std::invalid_argument("slice " + std::to_string(slice_id) + " has revision " +
                                std::to_string(*revision) + ", must be above " +
                                std::to_string(old_revision) + ", which is in the cloud");
  }
  SliceRecord record = place(slice_id, revision.value_or(old_revision + 1), patch, points_W);
  retire(position);
  make_live(position, std::move(record));
  return slices_[position];
}

CloudChange PointCloud::take_change() {
  begin_change();  // drops the last change, if nothing came after it
  CloudChange change;
  for (const std::int32_t slice_id : unreported_) {
    append_indices(*find_slice(slice_id), change.added);
  }
  for (const Retired& retired : retired_) {
    const SliceRecord& before = retired.record;
    free_.release(before.first, before.count);
    if (!retired.was_reported) continue;
    append_indices(before, change.removed);
    const SliceRecord* const after = find_slice(before.slice_id);
    if (after != nullptr) append_moved(before, *after, change.moved);
  }
  std::sort(change.added.begin(), change.added.end());
  std::sort(change.moved.begin(), change.moved.end(),
            [](const MovedPoint& a, const MovedPoint& b) { return a.to < b.to; });
  unreported_.clear();
  is_taken_ = true;
  return change;
}

void PointCloud::append_moved(const SliceRecord& before, const SliceRecord& after,
                              std::vector<MovedPoint>& moved) const {
  if (after.patch == PatchState::kNoPatch || voxel_m_ <= 0.0) {
    return append_moved_by_index(before, after, moved);
  }
  const auto points_of = [this](const SliceRecord& slice) {
    return points_W().subspan(slice.first, slice.count);
  };
  for (const PointPair& pair : pair_by_voxel(points_of(before), points_of(after), voxel_m_)) {
    moved.push_back({before.first + pair.before, after.first + pair.after});
  }
}

CloudChange PointCloud::everything() const {
  CloudChange change;
  change.added.reserve(num_live_);
  for (const Range& range : ranges_) append_indices(slices_[range.slice], change.added);
  return change;
}

const SliceRecord* PointCloud::find_slice(std::int32_t slice_id) const {
  const auto found = position_.find(slice_id);
  return found == position_.end() ? nullptr : &slices_[found->second];
}

const SliceRecord& PointCloud::slice_of(PointIndex i) const {
  if (const SliceRecord* const slice = find_live(i)) return *slice;
  const auto after = std::upper_bound(
      retired_.begin(), retired_.end(), i,
      [](PointIndex point, const Retired& retired) { return point < retired.record.first; });
  assert(after != retired_.begin());
  return std::prev(after)->record;
}

PointId PointCloud::id_of(PointIndex i) const {
  const SliceRecord& slice = slice_of(i);
  return {slice.slice_id, slice.index_of(i - slice.first)};
}

std::uint32_t PointCloud::position_of(std::int32_t slice_id) const {
  const auto found = position_.find(slice_id);
  if (found == position_.end()) {
    throw std::invalid_argument("slice_id " + std::to_string(slice_id) + " is not in the cloud");
  }
  return found->second;
}

const SliceRecord* PointCloud::find_live(PointIndex i) const {
  const auto after =
      std::upper_bound(ranges_.begin(), ranges_.end(), i,
                       [](PointIndex point, const Range& range) { return point < range.first; });
  if (after == ranges_.begin()) return nullptr;
  const SliceRecord& slice = slices_[std::prev(after)->slice];
  return i - slice.first < slice.count ? &slice : nullptr;
}

/// Ends the time in which the points removed by the last change stay readable.
void PointCloud::begin_change() {
  if (!std::exchange(is_taken_, false)) return;
  retired_.clear();
}

/// Stores the accepted points in the first free range that holds them all, or at the end.
SliceRecord PointCloud::place(std::int32_t slice_id, std::int32_t revision, PatchState patch,
                              std::span<const CloudPoint> points_W) {
  // LabelRun addresses a point in its slice by an int32.
  constexpr auto kMaxSlicePoints = std::numeric_limits<std::int32_t>::max();
  constexpr auto kMaxPoints = std::numeric_limits<PointIndex>::max() - 1;
  if (points_W.size() > kMaxSlicePoints || points_W.size() > kMaxPoints - points_W_.size()) {
    throw std::length_error("slice " + std::to_string(slice_id) + " of " +
                            std::to_string(points_W.size()) +
                            " points: the cloud would outgrow its 32-bit indices");
  }
  begin_change();
  SliceRecord slice;
  slice.slice_id = slice_id;
  slice.revision = revision;
  slice.patch = patch;
  slice.num_points = static_cast<std::int32_t>(points_W.size());
  for (std::int32_t index = 0; index < slice.num_points; ++index) {
    if (reason_to_reject(points_W[static_cast<std::size_t>(index)])) {
      slice.rejected.push_back(index);
    }
  }
  slice.count = static_cast<PointIndex>(points_W.size() - slice.rejected.size());
  if (slice.count == 0) return slice;

  const auto free = free_.take(slice.count);
  slice.first = free.value_or(size());
  if (!free) points_W_.resize(size() + slice.count);
  auto rejected = slice.rejected.begin();
  PointIndex next = slice.first;
  for (std::int32_t index = 0; index < slice.num_points; ++index) {
    if (rejected != slice.rejected.end() && *rejected == index) {
      ++rejected;
    } else {
      points_W_[next++] = points_W[static_cast<std::size_t>(index)];
    }
  }
  return slice;
}

void PointCloud::make_live(std::uint32_t slice, SliceRecord record) {
  unreported_.insert(record.slice_id);
  num_live_ += record.count;
  num_rejected_ += static_cast<std::int64_t>(record.rejected.size());
  if (record.count > 0) {
    const auto after =
        std::upper_bound(ranges_.begin(), ranges_.end(), record.first,
                         [](PointIndex first, const Range& range) { return first < range.first; });
    ranges_.insert(after, {record.first, slice});
  }
  slices_[slice] = std::move(record);
}

void PointCloud::retire(std::uint32_t slice) {
  SliceRecord& record = slices_[slice];
  const bool was_reported = unreported_.erase(record.slice_id) == 0;
  num_live_ -= record.count;
  num_rejected_ -= static_cast<std::int64_t>(record.rejected.size());
  if (record.count == 0) return;
  const auto range =
      std::lower_bound(ranges_.begin(), ranges_.end(), record.first,
                       [](const Range& other, PointIndex first) { return other.first < first; });
  assert(range != ranges_.end() && range->slice == slice);
  ranges_.erase(range);
  const auto after = std::upper_bound(
      retired_.begin(), retired_.end(), record.first,
      [](PointIndex first, const Retired& retired) { return first < retired.record.first; });
  retired_.insert(after, {std::move(record), was_reported});
}

}  // namespace kintsugi::segmenter
