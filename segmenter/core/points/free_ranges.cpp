#include "segmenter/core/points/free_ranges.hpp"

#include <algorithm>
#include <cassert>
#include <iterator>

namespace kintsugi::segmenter {

void FreeRanges::release(std::uint32_t first, std::uint32_t count) {
  if (count == 0) return;
  auto next = count_by_first_.lower_bound(first);
  assert(next == count_by_first_.end() || first + count <= next->first);
  if (next != count_by_first_.end() && next->first == first + count) {
    count += next->second;
    next = count_by_first_.erase(next);
  }
  if (next != count_by_first_.begin()) {
    const auto previous = std::prev(next);
    assert(previous->first + previous->second <= first);
    if (previous->first + previous->second == first) {
      previous->second += count;
      return;
    }
  }
  count_by_first_.emplace_hint(next, first, count);
}

std::optional<std::uint32_t> FreeRanges::take(std::uint32_t count) {
  assert(count > 0);
  const auto found = std::find_if(count_by_first_.begin(), count_by_first_.end(),
                                  [&](const auto& range) { return range.second >= count; });
  if (found == count_by_first_.end()) return std::nullopt;
  const auto [first, available] = *found;
  const auto next = count_by_first_.erase(found);
  if (available > count) count_by_first_.emplace_hint(next, first + count, available - count);
  return first;
}

}  // namespace kintsugi::segmenter
