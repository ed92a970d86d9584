#include "segmenter/core/exact/event_queue.hpp"

#include <array>

namespace kintsugi::segmenter::exact {
namespace {

// Three passes of 11 bits over the weight, the least significant first.
constexpr int kDigitBits = 11;
constexpr std::uint32_t kNumDigits = 1U << kDigitBits;
constexpr std::size_t kFewKeys = 256;

void scatter_by_digit(const std::vector<EdgeKey>& from, int shift, std::vector<EdgeKey>& to) {
  std::array<std::uint32_t, kNumDigits + 1> next{};
  const auto digit = [shift](const EdgeKey& key) {
    return (key.weight_bits >> shift) & (kNumDigits - 1);
  };
  for (const EdgeKey& key : from) ++next[digit(key) + 1];
  for (std::uint32_t d = 0; d < kNumDigits; ++d) next[d + 1] += next[d];
  for (const EdgeKey& key : from) to[next[digit(key)]++] = key;
}

}  // namespace

void sort_keys(std::vector<EdgeKey>& keys) {
  if (keys.size() < kFewKeys) {
    std::sort(keys.begin(), keys.end());
    return;
  }
  std::vector<EdgeKey> other(keys.size());
  for (int shift = 0; shift < 32; shift += kDigitBits) {
    scatter_by_digit(keys, shift, other);
    keys.swap(other);
  }
  for (auto first = keys.begin(); first != keys.end();) {
    const auto last = std::find_if(first + 1, keys.end(), [&](const EdgeKey& key) {
      return key.weight_bits != first->weight_bits;
    });
    if (last - first > 1) std::sort(first, last);
    first = last;
  }
}

}  // namespace kintsugi::segmenter::exact
