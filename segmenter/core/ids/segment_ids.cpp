#include "segmenter/core/ids/segment_ids.hpp"

#include <algorithm>
#include <cassert>
#include <stdexcept>
#include <string>
#include <utility>

#include "segmenter/core/ids/succession.hpp"

namespace kintsugi::segmenter {
namespace {

/// Counts the changed points by component and old id. Consecutive points are mostly alike.
std::vector<Overlap> count_overlaps(std::span<const ComponentId> components,
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

SegmentIds::SegmentIds(std::span<const ComponentId> components, std::span<const std::uint32_t> ids,
                       std::uint32_t next_id) {
  assert(components.size() == ids.size());
  grow(static_cast<PointIndex>(components.size()));
  segments_.resize(std::max(next_id, 1U));
  for (PointIndex p = 0; p < components.size(); ++p) {
    if (components[p] == kNoComponent) continue;
    const auto name = [&] {
      return "point " + std::to_string(p) + " of segment " + std::to_string(ids[p]);
    };
    if (ids[p] == kNoSegment || ids[p] >= next_id) {
      throw std::invalid_argument(name() + ": must be in 1 to " + std::to_string(next_id - 1));
    }
    const auto [known, is_new] = id_of_component_.try_emplace(components[p], ids[p]);
    Segment& segment = segments_[ids[p]];
    if (known->second != ids[p] || (is_new && segment.num_points > 0)) {
      throw std::invalid_argument(name() + ": the points make other segments than these");
    }
    segment.component = components[p];
    attach(p, ids[p]);
  }
}

IdUpdate SegmentIds::update(const PointCloud& cloud, const CloudChange& change,
                            std::span<const ComponentId> components,
                            std::span<const PointIndex> changed) {
  grow(static_cast<PointIndex>(components.size()));
  IdUpdate result;
  std::vector<std::uint32_t> losers = detach_removed(change, result.changes);
  std::vector<Overlap> overlaps = count_overlaps(components, changed, ids());
  const std::size_t num_gone = result.changes.size();
  detach_changed(change, changed, result.changes);

  // The unchanged points of the old segments that take part count as well.
  const std::vector<std::uint32_t> old_ids = touched_by(overlaps, std::move(losers));
  for (const std::uint32_t id : old_ids) {
    const Segment& rest = segments_[id];
    if (rest.num_points > 0) overlaps.push_back({components[rest.head], id, rest.num_points});
  }
  combine(overlaps);
  std::vector<Succession> successions = prefer(overlaps);
  find_first_points(cloud, components, changed, old_ids, successions);
  segments_.resize(assign_ids(successions, next_id()));

  detach_rests(old_ids, components, successions, result.changes);
  for (IdChange& move : std::span(result.changes).subspan(num_gone)) {
    move.new_id = find_succession(successions, components[move.point]).new_id;
    attach(move.point, move.new_id);
  }
  rename(old_ids, successions);
  std::erase_if(result.changes, [](const IdChange& c) { return c.old_id == c.new_id; });
  std::sort(result.changes.begin(), result.changes.end(),
            [](const IdChange& a, const IdChange& b) { return a.point < b.point; });
  result.events = events_of(successions, overlaps, old_ids);
  return result;
}

void SegmentIds::grow(PointIndex num_points) {
  ids_.resize(num_points, kNoSegment);
  members_.resize(num_points);
}

/// Gives the ids of moved points to their new indices and detaches removed points. Returns the ids
/// that lost points, once for each point.
std::vector<std::uint32_t> SegmentIds::detach_removed(const CloudChange& change,
                                                      std::vector<IdChange>& changes) {
  std::vector<std::uint32_t> losers;
  for (const PointIndex p : change.removed) changes.push_back({p, ids_[p], kNoSegment});
  for (const MovedPoint& moved : change.moved) {
    const std::uint32_t id = ids_[moved.from];
    detach(moved.from);
    attach(moved.to, id);
  }
  for (const PointIndex p : change.removed) {
    if (ids_[p] == kNoSegment) continue;
    losers.push_back(ids_[p]);
    detach(p);
  }
  return losers;
}

/// Detaches the changed points, which are attached to their new segments later.
void SegmentIds::detach_changed(const CloudChange& change, std::span<const PointIndex> changed,
                                std::vector<IdChange>& changes) {
  auto added = change.added.begin();
  for (const PointIndex p : changed) {
    added = std::find_if(added, change.added.end(), [&](PointIndex other) { return other >= p; });
    const bool is_new_place = added != change.added.end() && *added == p;
    changes.push_back({p, is_new_place ? kNoSegment : ids_[p], kNoSegment});
    detach(p);
  }
}

/// The old segments that lost points or share points with a changed component, by ascending id.
std::vector<std::uint32_t> SegmentIds::touched_by(std::span<const Overlap> overlaps,
                                                  std::vector<std::uint32_t> losers) const {
  std::vector<std::uint32_t> ids = std::move(losers);
  for (const Overlap& overlap : overlaps) {
    if (overlap.old_id != kNoSegment) ids.push_back(overlap.old_id);
    // The unchanged points of the component are in the segment that had its name before.
    const auto same_name = id_of_component_.find(overlap.component);
    if (same_name != id_of_component_.end()) ids.push_back(same_name->second);
  }
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

/// Finds the smallest PointIds where they decide. A component with a rival, or with a new id, has
/// no more unchanged points than it or its rival has changed ones. So it is cheap to look at all.
void SegmentIds::find_first_points(const PointCloud& cloud, std::span<const ComponentId> components,
                                   std::span<const PointIndex> changed,
                                   std::span<const std::uint32_t> old_ids,
                                   std::vector<Succession>& successions) const {
  SliceFinder slice_of(cloud);
  auto look_at = [&, last = std::size_t{0}](PointIndex p) mutable {
    if (successions[last].component != components[p]) {  // consecutive points are mostly alike
      const Succession& found = find_succession(successions, components[p]);
      last = static_cast<std::size_t>(&found - successions.data());
    }
    Succession& succession = successions[last];
    if (!succession.is_unrivalled)
      succession.first = std::min(succession.first, PointRank{slice_of(p).slice_id, p});
  };
  for (const PointIndex p : changed) look_at(p);
  for (const std::uint32_t id : old_ids) {
    if (segments_[id].num_points == 0) continue;
    if (find_succession(successions, components[segments_[id].head]).is_unrivalled) continue;
    for (const PointIndex p : points_of(id)) look_at(p);
  }
}

/// Detaches the unchanged points that get another id, before other points are attached.
void SegmentIds::detach_rests(std::span<const std::uint32_t> old_ids,
                              std::span<const ComponentId> components,
                              std::span<const Succession> successions,
                              std::vector<IdChange>& changes) {
  for (const std::uint32_t id : old_ids) {
    const Segment& rest = segments_[id];
    if (rest.num_points == 0) continue;
    if (find_succession(successions, components[rest.head]).new_id == id) continue;
    while (rest.num_points > 0) {
      changes.push_back({rest.head, id, kNoSegment});
      detach(rest.head);
    }
  }
}

void SegmentIds::rename(std::span<const std::uint32_t> old_ids,
                        std::span<const Succession> successions) {
  for (const std::uint32_t id : old_ids) id_of_component_.erase(segments_[id].component);
  for (const Succession& s : successions) {
    id_of_component_[s.component] = s.new_id;
    segments_[s.new_id].component = s.component;
  }
}

MemberLists::List SegmentIds::points_of(std::uint32_t segment_id) const {
  return members_.list(num_points_of(segment_id) > 0 ? segments_[segment_id].head
                                                     : MemberLists::kEmpty);
}

std::int64_t SegmentIds::num_points_of(std::uint32_t segment_id) const {
  return segment_id < segments_.size() ? segments_[segment_id].num_points : 0;
}

std::size_t SegmentIds::bytes() const {
  constexpr std::size_t kMapNodeBytes = 48;
  return ids_.bytes() + members_.bytes() + segments_.bytes() +
         id_of_component_.size() * kMapNodeBytes;
}

void SegmentIds::detach(PointIndex point) {
  if (ids_[point] == kNoSegment) return;
  Segment& segment = segments_[ids_[point]];
  segment.head = members_.erase(segment.head, point);
  --segment.num_points;
  ids_[point] = kNoSegment;
}

void SegmentIds::attach(PointIndex point, std::uint32_t segment_id) {
  Segment& segment = segments_[segment_id];
  segment.head =
      members_.insert(segment.num_points > 0 ? segment.head : MemberLists::kEmpty, point);
  ++segment.num_points;
  ids_[point] = segment_id;
}

}  // namespace kintsugi::segmenter
