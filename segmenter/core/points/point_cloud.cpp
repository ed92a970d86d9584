#include "segmenter/core/points/point_cloud.hpp"

#include <algorithm>
#include <cassert>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include <oneapi/tbb/parallel_for.h>

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

std::size_t bytes_P(const SliceRecord& slice) {
  return slice.points_P == nullptr ? 0 : slice.points_P->size() * sizeof(CloudPoint);
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
                                         std::span<const CloudPoint> points_P,
                                         std::int32_t revision, PatchState patch,
                                         const PatchPlace& place) {
  if (slice_id < 0) {
    throw std::invalid_argument("slice_id is " + std::to_string(slice_id) + ", must be >= 0");
  }
  if (position_.contains(slice_id)) {
    throw std::invalid_argument("slice_id " + std::to_string(slice_id) +
                                " is in the cloud already");
  }
  SliceRecord record =
      store({.slice_id = slice_id, .revision = revision, .patch = patch, .place = place}, points_P);
  const auto position = static_cast<std::uint32_t>(slices_.size());
  slices_.emplace_back();
  position_[slice_id] = position;
  make_live(position, std::move(record));
  return slices_[position];
}

const SliceRecord& PointCloud::replace_slice(std::int32_t slice_id,
                                             std::span<const CloudPoint> points_P,
                                             std::optional<std::int32_t> revision, PatchState patch,
                                             const PatchPlace& place) {
  const std::uint32_t position = position_of(slice_id);
  const std::int32_t old_revision = slices_[position].revision;
  if (revision.value_or(old_revision + 1) <= old_revision) {
    throw std::invalid_argument("slice " + std::to_string(slice_id) + " has revision " +
                                std::to_string(*revision) + ", must be above " +
                                std::to_string(old_revision) + ", which is in the cloud");
  }
  SliceRecord record = store({.slice_id = slice_id,
                              .revision = revision.value_or(old_revision + 1),
                              .patch = patch,
                              .place = place},
                             points_P);
  retire(position);
  make_live(position, std::move(record));
  return slices_[position];
}

const SliceRecord& PointCloud::move_slice(std::int32_t slice_id, const PatchPlace& place) {
  const std::uint32_t position = position_of(slice_id);
  SliceRecord& before = slices_[position];
  if (before.place.X_WP == place.X_WP) {
    before.place = place;
    return before;
  }
  check_size(slice_id, before.count);
  begin_change();
  SliceRecord record = before;
  record.place = place;
  PointsInPatch accepted_P = before.points_P;
  if (accepted_P == nullptr) {
    const std::span<const CloudPoint> points = points_P(before);
    accepted_P = std::make_shared<std::vector<CloudPoint>>(points.begin(), points.end());
  }
  this->place(record, std::move(accepted_P));
  retire(position);
  make_live(position, std::move(record));
  return slices_[position];
}

void PointCloud::move_in_place(std::span<const PlacedPatch> patches) {
  std::vector<std::uint32_t> positions;
  positions.reserve(patches.size());
  for (const PlacedPatch& patch : patches) positions.push_back(position_of(patch.id));
  begin_change();
  oneapi::tbb::parallel_for(std::size_t{0}, patches.size(), [&](std::size_t k) {
    put_in_place(slices_[positions[k]], patches[k].place);
  });
  bytes_P_ = 0;
  for (const SliceRecord& slice : slices_) bytes_P_ += bytes_P(slice);
  for (const PlacedPatch& patch : patches) moved_in_place_.insert(patch.id);
}

/// Moves the points of a slice from where they were received.
void PointCloud::put_in_place(SliceRecord& slice, const PatchPlace& place) {
  const bool is_same_pose = slice.place.X_WP == place.X_WP;
  slice.place = place;
  if (is_same_pose || slice.count == 0) return;
  PointsInPatch accepted_P = std::move(slice.points_P);
  if (accepted_P == nullptr) {
    const auto points = points_W().subspan(slice.first, slice.count);
    accepted_P = std::make_shared<std::vector<CloudPoint>>(points.begin(), points.end());
  }
  std::ranges::copy(moved(*accepted_P, place.X_WP), points_W_.begin() + slice.first);
  slice.points_P = place.X_WP.is_identity() ? nullptr : std::move(accepted_P);
}

/// The accepted points of a slice as received.
std::span<const CloudPoint> PointCloud::points_P(const SliceRecord& slice) const {
  if (slice.points_P != nullptr) return *slice.points_P;
  return points_W().subspan(slice.first, slice.count);
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
  for (const std::int32_t slice_id : moved_in_place_) {
    const SliceRecord& slice = *find_slice(slice_id);
    if (slice.count > 0) change.moved_in_place.push_back({slice.first, slice.count});
  }
  std::ranges::sort(change.moved_in_place, {}, &PointRange::first);
  moved_in_place_.clear();
  unreported_.clear();
  is_taken_ = true;
  return change;
}

void PointCloud::append_moved(const SliceRecord& before, const SliceRecord& after,
                              std::vector<MovedPoint>& moved) const {
  const bool is_same_revision = before.revision == after.revision;
  if (after.patch == PatchState::kNoPatch || voxel_m_ <= 0.0 || is_same_revision) {
    return append_moved_by_index(before, after, moved);
  }
  for (const PointPair& pair : pair_by_voxel(points_P(before), points_P(after), voxel_m_)) {
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

void PointCloud::check_size(std::int32_t slice_id, std::size_t num_points) const {
  // LabelRun addresses a point in its slice by an int32.
  constexpr auto kMaxSlicePoints = std::numeric_limits<std::int32_t>::max();
  constexpr auto kMaxPoints = std::numeric_limits<PointIndex>::max() - 1;
  if (num_points > kMaxSlicePoints || num_points > kMaxPoints - points_W_.size()) {
    throw std::length_error("slice " + std::to_string(slice_id) + " of " +
                            std::to_string(num_points) +
                            " points: the cloud would outgrow its 32-bit indices");
  }
}

/// Stores the points of a slice that are accepted.
SliceRecord PointCloud::store(SliceRecord slice, std::span<const CloudPoint> points_P) {
  check_size(slice.slice_id, points_P.size());
  begin_change();
  slice.num_points = static_cast<std::int32_t>(points_P.size());
  std::vector<CloudPoint> accepted_P;
  accepted_P.reserve(points_P.size());
  for (std::int32_t index = 0; const CloudPoint& point : points_P) {
    if (reason_to_reject(point)) {
      slice.rejected.push_back(index);
    } else {
      accepted_P.push_back(point);
    }
    ++index;
  }
  place(slice, std::make_shared<std::vector<CloudPoint>>(std::move(accepted_P)));
  return slice;
}

/// Stores accepted points in W, in the first free range that holds them all, or at the end.
void PointCloud::place(SliceRecord& slice, PointsInPatch accepted_P) {
  slice.count = static_cast<PointIndex>(accepted_P->size());
  slice.first = 0;
  slice.points_P = nullptr;
  if (slice.count == 0) return;
  const auto free = free_.take(slice.count);
  slice.first = free.value_or(size());
  if (!free) points_W_.resize(size() + slice.count);
  std::ranges::copy(moved(*accepted_P, slice.place.X_WP), points_W_.begin() + slice.first);
  if (!slice.place.X_WP.is_identity()) slice.points_P = std::move(accepted_P);
}

void PointCloud::make_live(std::uint32_t slice, SliceRecord record) {
  unreported_.insert(record.slice_id);
  num_live_ += record.count;
  bytes_P_ += bytes_P(record);
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
  bytes_P_ -= bytes_P(record);
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
