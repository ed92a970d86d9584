#pragma once
// Random numbers without a state: a hash of a counter. The same on every platform.

#include <cstdint>

namespace kintsugi::synthetic {

/// Mixes 32 bits so that consecutive inputs give unrelated outputs ("lowbias32", C. Wellons).
constexpr std::uint32_t hash32(std::uint32_t x) {
  x ^= x >> 16U;
  x *= 0x7feb352dU;
  x ^= x >> 15U;
  x *= 0x846ca68bU;
  x ^= x >> 16U;
  return x;
}

constexpr std::uint32_t hash32(std::uint32_t a, std::uint32_t b) {
  return hash32(a ^ (hash32(b) + 0x9e3779b9U));
}

/// In [0, 1), with 24 bits.
constexpr float unit_float(std::uint32_t hash) {
  return static_cast<float>(hash >> 8U) * (1.0F / 16777216.0F);
}

/// A sequence: the hash of (seed, 0), (seed, 1), ...
class CounterRandom {
 public:
  explicit CounterRandom(std::uint32_t seed) : seed_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * unit_float(hash32(seed_, counter_++));
  }
  int integer(int low, int high_inclusive) {
    return low + static_cast<int>(hash32(seed_, counter_++) %
                                  static_cast<std::uint32_t>(high_inclusive - low + 1));
  }

 private:
  std::uint32_t seed_;
  std::uint32_t counter_ = 0;
};

}  // namespace kintsugi::synthetic
