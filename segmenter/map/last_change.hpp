#pragma once

#include <cstdint>

namespace kintsugi::segmenter {

/// The last slice with which points of a segment came, left or moved: that of the last
/// SegmentUpdate with statistics of the segment. LastChange{}: not known.
struct LastChange {
  std::int64_t utime = 0;  ///< device time of that slice, microseconds
  std::int32_t slice_id = -1;
  std::int32_t reserved = 0;  ///< zero; instead of padding, since files hold this struct

  bool operator==(const LastChange&) const = default;
};
static_assert(sizeof(LastChange) == 16);

}  // namespace kintsugi::segmenter
