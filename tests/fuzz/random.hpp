#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

namespace kintsugi::segmenter::fuzz {

/// Random numbers for scenarios, the same for the same seed with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : generator_(seed) {}

  /// In [0, bound); `bound` > 0.
  std::size_t below(std::size_t bound) { return generator_() % bound; }
  /// In [first, last].
  std::size_t between(std::size_t first, std::size_t last) {
    return first + below(last - first + 1);
  }
  /// In [0, 1).
  double unit() { return static_cast<double>(generator_() >> 11U) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * unit(); }
  /// As likely in each octave of [low, high); low > 0.
  double log_uniform(double low, double high) { return low * std::pow(high / low, unit()); }
  bool chance(double probability) { return unit() < probability; }

  template <typename T>
  const T& pick(const std::vector<T>& from) {
    return from[below(from.size())];
  }
  template <typename T>
  void shuffle(std::vector<T>& items) {
    for (std::size_t i = items.size(); i > 1; --i) std::swap(items[i - 1], items[below(i)]);
  }

 private:
  std::mt19937_64 generator_;
};

}  // namespace kintsugi::segmenter::fuzz
