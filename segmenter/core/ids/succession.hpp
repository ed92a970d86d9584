#pragma once
// Who inherits which segment id, and what that means as events.

#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/core/engine/engine.hpp"
#include "segmenter/core/points/point_cloud.hpp"

namespace kintsugi::segmenter {

/// Points that a component of the new partition shares with an old segment.
struct Overlap {
  ComponentId component = 0;
  std::uint32_t old_id = kNoSegment;  ///< kNoSegment: points that are new
  std::int64_t count = 0;
};

/// The order of points by their PointId: within a slice it is that of their places in the cloud.
struct PointRank {
  std::int32_t slice_id = INT32_MAX;
  PointIndex point = UINT32_MAX;

  bool operator<(const PointRank& other) const {
    return std::tie(slice_id, point) < std::tie(other.slice_id, other.point);
  }
};

/// A component that changed, with the id it had most of and the id it gets.
struct Succession {
  ComponentId component = 0;
  std::uint32_t preferred_id = kNoSegment;
  std::int64_t shared = 0;  ///< with preferred_id
  std::uint32_t new_id = kNoSegment;
  bool gained = false;         ///< has points that preferred_id had not
  bool is_unrivalled = false;  ///< shares more with preferred_id than any other that prefers it
  PointRank first;             ///< its first point; where is_unrivalled nobody asks for it
};

/// Sorts by (component, old id) and adds up the counts of equal pairs.
void combine(std::vector<Overlap>& overlaps);

/// For each component in `overlaps` (combined) the id it shares most points with, ties to the
/// smaller, and whether it has a rival; new_id and first are left open. By ascending component.
std::vector<Succession> prefer(std::span<const Overlap> overlaps);

/// Gives each preferred id to the component that shares most with it, ties to the one that has the
/// first point; new ids from `next_id` on to the others, by ascending first point. Returns the id
/// after the last.
std::uint32_t hand_out(std::vector<Succession>& successions, std::uint32_t next_id);

/// That of `component`, which must be there.
const Succession& find_succession(std::span<const Succession> successions, ComponentId component);

/// The events as IdUpdate documents them, by type, then segment_id, then other_id. `old_ids` are
/// those that take part: all in `overlaps`, and those whose points are all gone.
std::vector<SegmentEvent> tell_events(std::span<const Succession> successions,
                                      std::span<const Overlap> overlaps,
                                      std::span<const std::uint32_t> old_ids);

}  // namespace kintsugi::segmenter
