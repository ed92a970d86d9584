#pragma once

#include <cstdint>
#include <map>
#include <optional>

namespace kintsugi::segmenter {

/// Ranges of indices that may be used again. Adjacent ranges are merged.
class FreeRanges {
 public:
  /// Adds [first, first + count), of which nothing may be free already.
  void release(std::uint32_t first, std::uint32_t count);

  /// Takes `count` > 0 indices from the beginning of the first range that has as many. Returns the
  /// first of them; nothing when no range is large enough.
  std::optional<std::uint32_t> take(std::uint32_t count);

 private:
  std::map<std::uint32_t, std::uint32_t> count_by_first_;
};

}  // namespace kintsugi::segmenter
