#pragma once

#include <cstdint>

namespace kintsugi::segmenter {

/// The slice with which a segment last got, lost or exchanged points: of the last SegmentUpdate
/// that has statistics of it. LastChange{}: not known.
struct LastChange {
  std::int64_t utime = 0;  ///< device time of that slice, microseconds
  std::int32_t slice_id = -1;
  std::int32_t reserved = 0;  ///< zero; there is no padding, for files

  bool operator==(const LastChange&) const = default;
};
static_assert(sizeof(LastChange) == 16);

}  // namespace kintsugi::segmenter
