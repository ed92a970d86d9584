#pragma once

#include <cstdint>

namespace kintsugi::segmenter::exact {

/// The predicate that decides joins: Eq. 3 and Algorithm 1, line 8. T and k as in EngineConfig.
struct JoinRule {
  double threshold = 0.0;  ///< T
  double scale = 0.0;      ///< k

  /// The component is alive whatever its size.
  static constexpr std::int32_t kUnbounded = 1 << 30;

  /// theta of a component of `size` points whose last join had `weight`, which is ignored for a
  /// single point.
  double theta(float weight, std::uint32_t size) const {
    return size == 1 ? threshold : static_cast<double>(weight) + scale / static_cast<double>(size);
  }

  /// The most points that a component may have after a join at `weight` to be alive at an edge of
  /// `next_weight` (>= weight). At least 1, although no join makes a component of one point.
  std::int32_t capacity(float weight, float next_weight) const {
    const double w = next_weight;
    const auto is_alive = [&](double size) {
      return w < static_cast<double>(weight) + scale / size;
    };
    if (next_weight <= weight) return is_alive(kUnbounded) ? kUnbounded : largest(is_alive);
    const double estimate = scale / (w - static_cast<double>(weight));
    if (estimate >= kUnbounded - 2) return kUnbounded;
    // The estimate is rounded, so the predicate itself decides.
    auto size = static_cast<std::uint32_t>(estimate) + 1;
    while (is_alive(size + 1.0)) ++size;
    while (size > 1 && !is_alive(size)) --size;
    return static_cast<std::int32_t>(size);
  }

 private:
  /// The largest size, at least 1, for which is_alive(size), which is false for kUnbounded. Needed
  /// for equal weights: where k / size is rounded away, theta is the weight itself.
  template <typename IsAlive>
  static std::int32_t largest(const IsAlive& is_alive) {
    std::int32_t largest = 1;
    std::int32_t too_large = kUnbounded;
    while (too_large - largest > 1) {
      const std::int32_t middle = largest + (too_large - largest) / 2;
      (is_alive(middle) ? largest : too_large) = middle;
    }
    return largest;
  }
};

}  // namespace kintsugi::segmenter::exact
