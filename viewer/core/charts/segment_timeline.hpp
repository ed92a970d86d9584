#pragma once

#include <cstdint>
#include <vector>

#include "viewer/core/map/update_log.hpp"

namespace kintsugi::viewer {

/// History of one segment: its events and its size. Time is the number of slices in the map.
struct SegmentTimeline {
  enum class EventType {
    kCreated,
    kSplitOff,    ///< it began as a part of `other_id`
    kAbsorbed,    ///< `other_id` was merged into it
    kSplit,       ///< `other_id` was split off from it
    kMergedInto,  ///< it was merged into `other_id`
    kRetired,     ///< none of its points is left
  };
  struct Event {
    std::int32_t num_slices = 0;
    EventType type = EventType::kCreated;
    std::uint32_t other_id = 0;
    std::uint32_t other_points = 0;  ///< before the merge or after the split; 0: unknown

    bool operator==(const Event&) const = default;
  };
  struct Size {
    std::int32_t num_slices = 0;
    std::uint32_t num_points = 0;  ///< until the next size

    bool operator==(const Size&) const = default;
  };

  std::uint32_t segment_id = 0;
  std::int32_t num_slices = 0;  ///< in the map, at the end of the log
  std::vector<Event> events;
  std::vector<Size> sizes;  ///< changes only

  /// The log has a size of the segment.
  bool is_known() const { return !sizes.empty(); }
  /// The log has the beginning of the segment; otherwise it starts later.
  bool has_beginning() const;
};

/// Empty for kNoSegment, which is no segment.
SegmentTimeline timeline_of(std::uint32_t segment_id, const UpdateLog& log);

}  // namespace kintsugi::viewer
