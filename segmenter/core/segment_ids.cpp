#include "segmenter/core/segment_ids.hpp"

#include <algorithm>
#include <utility>

#include "segmenter/core/succession.hpp"

namespace kintsugi::segmenter {
namespace {

/// Counts the changed points by component and old id; neighbouring points mostly agree.
std::vector<Overlap> count_overlaps(std::span<const PointIndex> components,
                                    std::span<const PointIndex> changed,
                                    std::span<const std::uint32_t> ids) {
  std::vector<Overlap> overlaps;
  for (const PointIndex p : changed) {
    if (overlaps.empty() || overlaps.back().component != components[p] ||
        overlaps.back().old_id != ids[p]) {
      overlaps.push_back({components[p], ids[p], 0});
    }
    ++overlaps.back().count;
  }
  combine(overlaps);
  return overlaps;
}

}  // namespace

IdUpdate SegmentIds::update(std::span<const PointIndex> components,
                            std::span<const PointIndex> changed) {
  ids_.resize(components.size(), kNoSegment);
  slot_.resize(components.size(), 0);
  std::vector<Overlap> overlaps = count_overlaps(components, changed, ids_);
  std::vector<IdChange> moves;
  for (const PointIndex p : changed) moves.push_back({p, ids_[p], kNoSegment});
  for (const PointIndex p : changed) detach(p);

  // What is left of the old segments that are touched counts as well.
  const std::vector<std::uint32_t> rests = touched_rests(overlaps);
  for (const std::uint32_t id : rests) {
    overlaps.push_back({components[points_[id].front()], id, std::ssize(points_[id])});
  }
  combine(overlaps);
  std::vector<Succession> successions = prefer(overlaps);
  points_.resize(hand_out(successions, next_id()));

  // Rests that take another id leave before anyone moves in.
  for (const std::uint32_t id : rests) {
    if (find_succession(successions, components[points_[id].front()]).new_id == id) continue;
    for (const PointIndex p : std::exchange(points_[id], {})) moves.push_back({p, id, kNoSegment});
  }
  for (IdChange& move : moves) {
    move.new_id = find_succession(successions, components[move.point]).new_id;
    attach(move.point, move.new_id);
  }
  std::erase_if(moves, [](const IdChange& move) { return move.old_id == move.new_id; });
  std::sort(moves.begin(), moves.end(),
            [](const IdChange& a, const IdChange& b) { return a.point < b.point; });

  IdUpdate result{std::move(moves), tell_events(successions, overlaps)};
  for (const SegmentEvent& event : result.events) {
    num_segments_ +=
        event.type == SegmentEventType::kCreated || event.type == SegmentEventType::kSplit;
    num_segments_ -= event.type == SegmentEventType::kMerged;
  }
  return result;
}

/// The old segments that lost changed points or that a changed component builds on, as far as they
/// still have points; the changed points are detached already.
std::vector<std::uint32_t> SegmentIds::touched_rests(std::span<const Overlap> overlaps) const {
  std::vector<std::uint32_t> ids;
  for (const Overlap& overlap : overlaps) {
    ids.push_back(overlap.old_id);
    // A component that was there before still holds its representative.
    ids.push_back(ids_[overlap.component]);
  }
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  std::erase_if(ids, [&](std::uint32_t id) { return points_[id].empty(); });
  return ids;
}

std::span<const PointIndex> SegmentIds::points_of(std::uint32_t segment_id) const {
  if (segment_id >= points_.size()) return {};
  return points_[segment_id];
}

void SegmentIds::detach(PointIndex point) {
  if (ids_[point] == kNoSegment) return;
  std::vector<PointIndex>& points = points_[ids_[point]];
  const PointIndex moved = points.back();
  points[slot_[point]] = moved;
  slot_[moved] = slot_[point];
  points.pop_back();
  if (points.empty()) points.shrink_to_fit();
  ids_[point] = kNoSegment;
}

void SegmentIds::attach(PointIndex point, std::uint32_t segment_id) {
  std::vector<PointIndex>& points = points_[segment_id];
  ids_[point] = segment_id;
  slot_[point] = static_cast<std::uint32_t>(points.size());
  points.push_back(point);
}

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
                                 PointIndex end) {
  std::vector<LabelRun> runs;
  for (const IdChange& change : changes) {
    if (change.point >= end) break;
    const PointId id = cloud.id_of(change.point);
    const bool goes_on = !runs.empty() && runs.back().slice_id == id.slice_id &&
                         runs.back().first + runs.back().count == id.index &&
                         runs.back().segment_id == change.new_id;
    if (!goes_on) runs.push_back({id.slice_id, id.index, 0, change.new_id});
    ++runs.back().count;
  }
  return runs;
}

}  // namespace kintsugi::segmenter
