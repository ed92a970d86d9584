#pragma once
// Which component inherits which segment id, and the events that follow from it.

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
  std::uint32_t old_id = kNoSegment;  ///< kNoSegment: these points are new
  std::int64_t count = 0;
};

/// Orders points by their PointId: within a slice it is the order of their PointIndices.
struct PointRank {
  std::int32_t slice_id = INT32_MAX;
  PointIndex point = UINT32_MAX;

  bool operator<(const PointRank& other) const {
    return std::tie(slice_id, point) < std::tie(other.slice_id, other.point);
  }
};

/// A component that changed, with the id that it would inherit and the id that it gets.
struct Succession {
  ComponentId component = 0;
  std::uint32_t preferred_id = kNoSegment;  ///< of the old segment that it shares most points with
  std::int64_t shared = 0;                  ///< with preferred_id
  std::uint32_t new_id = kNoSegment;
  bool gained = false;         ///< has points that the old segment did not have
  bool is_unrivalled = false;  ///< shares more with it than any other that prefers the same id
  PointRank first;             ///< its smallest point; not set where is_unrivalled
};

/// Sorts by (component, old id) and adds up the counts of equal pairs.
void combine(std::vector<Overlap>& overlaps);

/// For each component in `overlaps`, on which combine() was called: preferred_id, shared, gained
/// and is_unrivalled. By ascending component.
std::vector<Succession> prefer(std::span<const Overlap> overlaps);

/// Sets new_id: each preferred id goes to the component that shares most with it, on a tie to the
/// one with the smallest point; the others get new ids from `next_id` on, by their smallest points.
/// Returns the id after the last one.
std::uint32_t assign_ids(std::vector<Succession>& successions, std::uint32_t next_id);

/// The element for `component`, which must exist.
const Succession& find_succession(std::span<const Succession> successions, ComponentId component);

/// The events that IdUpdate describes, by type, then segment_id, then other_id. `old_ids` are all
/// ids in `overlaps` and those that lost all their points.
std::vector<SegmentEvent> events_of(std::span<const Succession> successions,
                                    std::span<const Overlap> overlaps,
                                    std::span<const std::uint32_t> old_ids);

}  // namespace kintsugi::segmenter
