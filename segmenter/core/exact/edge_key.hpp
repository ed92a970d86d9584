#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "segmenter/core/points/point_cloud.hpp"

namespace kintsugi::segmenter::exact {

/// The position of an edge in the order in which Algorithm 1 takes the edges: by weight, ties by
/// the two points, the smaller one first. It serves as time in the history of joins.
struct EdgeKey {
  std::uint32_t weight_bits = UINT32_MAX;  ///< of a float32 >= 0, which are ordered as its values
  PointIndex a = UINT32_MAX;               ///< < b
  PointIndex b = UINT32_MAX;

  static EdgeKey of(float weight, PointIndex i, PointIndex j) {
    return {std::bit_cast<std::uint32_t>(weight), std::min(i, j), std::max(i, j)};
  }
  float weight() const { return std::bit_cast<float>(weight_bits); }

  bool operator==(const EdgeKey&) const = default;
  bool operator<(const EdgeKey& other) const {
    if (weight_bits != other.weight_bits) return weight_bits < other.weight_bits;
    return a != other.a ? a < other.a : b < other.b;
  }
};

/// Later than every edge.
inline constexpr EdgeKey kNever{};

}  // namespace kintsugi::segmenter::exact
