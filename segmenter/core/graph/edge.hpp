#pragma once

#include <tuple>

#include "segmenter/core/points/point_cloud.hpp"

namespace kintsugi::segmenter {

/// e_ij of Eq. 1. Weights are >= 0.
struct Edge {
  float weight = 0.0F;
  PointIndex i = 0;
  PointIndex j = 0;

  bool operator==(const Edge&) const = default;
};

/// The order in which Algorithm 1 takes the edges. The partition does not depend on the order of
/// equal weights; ties are broken by the points so that the order itself is unique.
struct AscendingWeight {
  bool operator()(const Edge& a, const Edge& b) const {
    return std::tie(a.weight, a.i, a.j) < std::tie(b.weight, b.i, b.j);
  }
};

}  // namespace kintsugi::segmenter
