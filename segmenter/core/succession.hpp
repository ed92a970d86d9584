#pragma once
// Who inherits which segment id, and what that means as events.

#include <cstdint>
#include <span>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/core/point_cloud.hpp"

namespace kintsugi::segmenter {

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
void combine(std::vector<Overlap>& overlaps);

/// For each component in `overlaps` (combined) the id it shares most points with, ties to the
/// smaller; new_id is left open. By ascending component.
std::vector<Succession> prefer(std::span<const Overlap> overlaps);

/// Gives each preferred id to the component that shares most with it, ties to the smaller
/// representative, and new ids from `next_id` on to the others. Returns the id after the last.
std::uint32_t hand_out(std::vector<Succession>& successions, std::uint32_t next_id);

/// That of `component`, which must be there.
const Succession& find_succession(std::span<const Succession> successions, PointIndex component);

/// The events as IdUpdate documents them, by type, then segment_id, then other_id.
std::vector<SegmentEvent> tell_events(std::span<const Succession> successions,
                                      std::span<const Overlap> overlaps);

}  // namespace kintsugi::segmenter
