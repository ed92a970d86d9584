#pragma once

#include <cstdint>
#include <map>
#include <optional>

namespace kintsugi::segmenter {

/// Ranges of indices that may be used again. Neighbouring ranges are one.
class FreeRanges {
 public:
  /// Makes [first, first + count) free; none of it may be free already.
  void release(std::uint32_t first, std::uint32_t count);

  /// The beginning of the first free range that holds `count` > 0 indices, which are taken from it.
  std::optional<std::uint32_t> take(std::uint32_t count);

 private:
  std::map<std::uint32_t, std::uint32_t> count_by_first_;
};

}  // namespace kintsugi::segmenter
