#include "segmenter/core/ids/slice_labels.hpp"

#include <algorithm>
#include <utility>

#include "segmenter/core/ids/succession.hpp"

namespace kintsugi::segmenter {
namespace {

/// Points with their new ids.
using Relabelled = std::vector<std::pair<PointRank, std::uint32_t>>;

/// Appends the points of slices that were moved as they were. Who has their labels has them still.
void append_moved(const PointCloud& cloud, std::span<const IdChange> changes,
                  std::span<const MovedPoint> moved, std::span<const std::uint32_t> ids,
                  Relabelled& relabelled) {
  SliceFinder slice_before(cloud);
  SliceFinder slice_after(cloud);
  auto change = changes.begin();  // of the point where it was; mostly the next one
  for (const MovedPoint& point : moved) {
    const SliceRecord& after = slice_after(point.to);
    if (slice_before(point.from).revision != after.revision) continue;
    if (change == changes.end() || change->point != point.from) {
      change = std::ranges::lower_bound(changes, point.from, {}, &IdChange::point);
    }
    const std::uint32_t new_id = ids[point.to];
    if (change->old_id != new_id) relabelled.push_back({{after.slice_id, point.to}, new_id});
    ++change;
  }
}

}  // namespace

std::vector<std::uint32_t> slice_labels(const SliceRecord& slice,
                                        std::span<const std::uint32_t> ids) {
  std::vector<std::uint32_t> labels(static_cast<std::size_t>(slice.num_points), kNoSegment);
  auto rejected = slice.rejected.begin();
  PointIndex point = slice.first;
  for (std::int32_t index = 0; index < slice.num_points; ++index) {
    if (rejected != slice.rejected.end() && *rejected == index) {
      ++rejected;
    } else {
      labels[static_cast<std::size_t>(index)] = ids[point++];
    }
  }
  return labels;
}

std::vector<LabelRun> label_runs(const PointCloud& cloud, std::span<const IdChange> changes,
                                 std::span<const MovedPoint> moved,
                                 std::span<const std::uint32_t> ids) {
  Relabelled relabelled;
  SliceFinder slice_of(cloud);
  for (const IdChange& change : changes) {
    if (change.old_id == kNoSegment || change.new_id == kNoSegment) continue;
    relabelled.emplace_back(PointRank{slice_of(change.point).slice_id, change.point},
                            change.new_id);
  }
  append_moved(cloud, changes, moved, ids, relabelled);
  std::sort(relabelled.begin(), relabelled.end());

  std::vector<LabelRun> runs;
  for (const auto& [place, new_id] : relabelled) {
    const SliceRecord& slice = slice_of(place.point);
    const PointId id{slice.slice_id, slice.index_of(place.point - slice.first)};
    const bool goes_on = !runs.empty() && runs.back().slice_id == id.slice_id &&
                         runs.back().first + runs.back().count == id.index &&
                         runs.back().segment_id == new_id;
    if (!goes_on) {
      runs.push_back({id.slice_id, id.index, 0, new_id, slice.revision});
    }
    ++runs.back().count;
  }
  return runs;
}

}  // namespace kintsugi::segmenter
