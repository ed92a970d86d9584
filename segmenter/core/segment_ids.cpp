#include "segmenter/core/segment_ids.hpp"

#include <algorithm>
#include <cassert>
#include <tuple>
#include <utility>

namespace kintsugi::segmenter {
namespace {

/// Points that a component of the new partition shares with an old segment.
struct Overlap {
  PointIndex component = 0;
  std::uint32_t old_id = kNoSegment;  ///< kNoSegment: points that are new
  std::int64_t count = 0;
};

/// A component that changed, with the id it had most of and the id it gets.
struct Succession {
  PointIndex component = 0;
  std::uint32_t preferred_id = kNoSegment;
  std::int64_t shared = 0;  ///< with preferred_id
  std::uint32_t new_id = kNoSegment;
  bool gained = false;  ///< has points that preferred_id had not
};

/// Sorts by (component, old id) and adds up the counts of equal pairs.
void combine(std::vector<Overlap>& overlaps) {
  std::sort(overlaps.begin(), overlaps.end(), [](const Overlap& a, const Overlap& b) {
    return std::tie(a.component, a.old_id) < std::tie(b.component, b.old_id);
  });
  std::size_t kept = 0;
  for (std::size_t i = 1; i < overlaps.size(); ++i) {
    if (overlaps[i].component == overlaps[kept].component &&
        overlaps[i].old_id == overlaps[kept].old_id) {
      overlaps[kept].count += overlaps[i].count;
    } else {
      overlaps[++kept] = overlaps[i];
    }
  }
  if (!overlaps.empty()) overlaps.resize(kept + 1);
}

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

/// The id that each component shares most points with, ties to the smaller; by component.
std::vector<Succession> prefer(std::span<const Overlap> overlaps) {
  std::vector<Succession> successions;
  for (const Overlap& overlap : overlaps) {
    if (successions.empty() || successions.back().component != overlap.component) {
      successions.push_back({.component = overlap.component});
    } else {
      successions.back().gained = true;
    }
    Succession& last = successions.back();
    if (overlap.old_id != kNoSegment && overlap.count > last.shared) {
      last.preferred_id = overlap.old_id;
      last.shared = overlap.count;
    }
  }
  return successions;
}

/// Gives each preferred id to the component that shares most with it, ties to the smaller
/// representative, and new ids from `next_id` on to the others. Returns the id after the last.
std::uint32_t hand_out(std::vector<Succession>& successions, std::uint32_t next_id) {
  std::vector<Succession*> claims;
  for (Succession& s : successions) {
    if (s.preferred_id != kNoSegment) claims.push_back(&s);
  }
  std::sort(claims.begin(), claims.end(), [](const Succession* a, const Succession* b) {
    return std::tuple(a->preferred_id, -a->shared, a->component) <
           std::tuple(b->preferred_id, -b->shared, b->component);
  });
  std::uint32_t inherited = kNoSegment;
  for (Succession* claim : claims) {
    if (claim->preferred_id == inherited) continue;
    inherited = claim->preferred_id;
    claim->new_id = inherited;
  }
  for (Succession& s : successions) {
    if (s.new_id == kNoSegment) s.new_id = next_id++;
  }
  return next_id;
}

const Succession& succession_of(std::span<const Succession> successions, PointIndex component) {
  const auto found =
      std::lower_bound(successions.begin(), successions.end(), component,
                       [](const Succession& s, PointIndex value) { return s.component < value; });
  assert(found != successions.end() && found->component == component);
  return *found;
}

void append_births(std::span<const Succession> successions, std::vector<SegmentEvent>& events) {
  for (const Succession& s : successions) {
    if (s.preferred_id == kNoSegment) {
      events.push_back({SegmentEventType::kCreated, s.new_id, 0});
    } else if (s.new_id != s.preferred_id) {
      events.push_back({SegmentEventType::kSplit, s.preferred_id, s.new_id});
    } else if (s.gained) {
      events.push_back({SegmentEventType::kGrown, s.new_id, 0});
    }
  }
}

/// An old id without an heir went to the component that took most of it, ties to the smaller id.
void append_mergers(std::span<const Succession> successions, std::span<const Overlap> overlaps,
                    std::vector<SegmentEvent>& events) {
  struct Share {
    std::uint32_t old_id;
    std::int64_t count;
    std::uint32_t new_id;
  };
  std::vector<Share> shares;
  for (const Overlap& overlap : overlaps) {
    if (overlap.old_id == kNoSegment) continue;
    const Succession& taker = succession_of(successions, overlap.component);
    shares.push_back({overlap.old_id, overlap.count, taker.new_id});
  }
  std::sort(shares.begin(), shares.end(), [](const Share& a, const Share& b) {
    return std::tuple(a.old_id, -a.count, a.new_id) < std::tuple(b.old_id, -b.count, b.new_id);
  });
  for (auto first = shares.begin(); first != shares.end();) {
    const auto last = std::find_if(
        first, shares.end(), [&](const Share& share) { return share.old_id != first->old_id; });
    const bool has_heir =
        std::any_of(first, last, [](const Share& share) { return share.new_id == share.old_id; });
    if (!has_heir) {
      events.push_back({SegmentEventType::kMerged, first->new_id, first->old_id});
    }
    first = last;
  }
}

}  // namespace

IdUpdate SegmentIds::update(std::span<const PointIndex> components,
                            std::span<const PointIndex> changed) {
  ids_.resize(components.size(), kNoSegment);
  slot_.resize(components.size(), 0);
  std::vector<Overlap> overlaps = count_overlaps(components, changed, ids_);

  IdUpdate result;
  std::vector<std::uint32_t> touched_ids;
  for (const PointIndex p : changed) {
    result.changes.push_back({p, ids_[p], kNoSegment});
    if (ids_[p] != kNoSegment) {
      touched_ids.push_back(ids_[p]);
      detach(p);
    }
  }
  // What is left of an old segment kept its representative, which is one of its points.
  for (const Overlap& overlap : overlaps) {
    if (ids_[overlap.component] != kNoSegment) touched_ids.push_back(ids_[overlap.component]);
  }
  std::sort(touched_ids.begin(), touched_ids.end());
  touched_ids.erase(std::unique(touched_ids.begin(), touched_ids.end()), touched_ids.end());
  for (const std::uint32_t id : touched_ids) {
    const std::vector<PointIndex>& rest = points_[id];
    if (rest.empty()) continue;
    overlaps.push_back({components[rest.front()], id, static_cast<std::int64_t>(rest.size())});
  }
  combine(overlaps);

  std::vector<Succession> successions = prefer(overlaps);
  points_.resize(hand_out(successions, next_id()));
  const auto id_of = [&](PointIndex component) {
    return succession_of(successions, component).new_id;
  };

  // The rests that change id leave first: another segment may move into theirs.
  for (const std::uint32_t id : touched_ids) {
    if (points_[id].empty() || id_of(components[points_[id].front()]) == id) continue;
    for (const PointIndex p : std::exchange(points_[id], {})) {
      result.changes.push_back({p, id, kNoSegment});
    }
  }
  for (IdChange& change : result.changes) {
    change.new_id = id_of(components[change.point]);
    attach(change.point, change.new_id);
  }
  std::erase_if(result.changes, [](const IdChange& c) { return c.old_id == c.new_id; });
  std::sort(result.changes.begin(), result.changes.end(),
            [](const IdChange& a, const IdChange& b) { return a.point < b.point; });

  append_births(successions, result.events);
  append_mergers(successions, overlaps, result.events);
  for (const SegmentEvent& event : result.events) {
    num_segments_ +=
        event.type == SegmentEventType::kCreated || event.type == SegmentEventType::kSplit;
    num_segments_ -= event.type == SegmentEventType::kMerged;
  }
  std::sort(result.events.begin(), result.events.end(),
            [](const SegmentEvent& a, const SegmentEvent& b) {
              return std::tie(a.type, a.segment_id, a.other_id) <
                     std::tie(b.type, b.segment_id, b.other_id);
            });
  return result;
}

std::span<const PointIndex> SegmentIds::points_of(std::uint32_t segment_id) const {
  if (segment_id >= points_.size()) return {};
  return points_[segment_id];
}

void SegmentIds::detach(PointIndex point) {
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

}  // namespace kintsugi::segmenter
