#pragma once

#include <cstdint>
#include <vector>

#include "viewer/core/scene/update_log.hpp"

namespace kintsugi::viewer {

/// What became of one segment while the map grew. Time is the number of slices in the map.
struct SegmentTimeline {
  enum class EventType {
    kCreated,
    kSplitOff,    ///< began as a part of `other_id`
    kAbsorbed,    ///< took in `other_id`, which is gone
    kSplit,       ///< `other_id` left it
    kMergedInto,  ///< ended as a part of `other_id`
    kRetired,     ///< none of its points is left
  };
  struct Event {
    std::int32_t num_slices = 0;
    EventType type = EventType::kCreated;
    std::uint32_t other_id = 0;
    std::uint32_t other_points = 0;  ///< before it was absorbed, or after it left; 0: not known

    bool operator==(const Event&) const = default;
  };
  struct Size {
    std::int32_t num_slices = 0;
    std::uint32_t num_points = 0;  ///< from then on

    bool operator==(const Size&) const = default;
  };

  std::uint32_t segment_id = 0;
  std::int32_t num_slices = 0;  ///< of the map, as far as the log goes
  std::vector<Event> events;
  std::vector<Size> sizes;  ///< each other than the one before

  /// The segment was there at some time, as far as the log goes.
  bool is_known() const { return !sizes.empty(); }
  /// How it began was heard; otherwise the log begins when the segment was there.
  bool has_beginning() const;
};

SegmentTimeline timeline_of(std::uint32_t segment_id, const UpdateLog& log);

}  // namespace kintsugi::viewer
