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

/// The order in which edges are looked at: ascending weight. Equal weights give the same partition
/// in any order; the points break ties so that the order, too, is one and the same.
struct AscendingWeight {
  bool operator()(const Edge& a, const Edge& b) const {
    return std::tie(a.weight, a.i, a.j) < std::tie(b.weight, b.i, b.j);
  }
};

}  // namespace kintsugi::segmenter
