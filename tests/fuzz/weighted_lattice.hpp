#pragma once

#include <set>
#include <span>
#include <utility>
#include <vector>

#include "tests/fuzz/scenario.hpp"

namespace kintsugi::segmenter::fuzz {

/// Points whose edges have given weights.
///
/// They stand on a lattice in a plane, 15 mm apart: with a radius of 20 mm those side by side are
/// neighbours, those across a square (21 mm) are not. All normals are upright, so that no edge is
/// convex, and of lengths a_i near 1, so that c = 1 - n_i . n_j = 1 - a_i a_j is the weight. Along
/// a tree any weights can be had. Where a tree closes a square, the fourth weight follows from the
/// other three: opposite weights have (almost) the same sum.
class WeightedLattice {
 public:
  struct Site {
    int x;
    int y;
  };

  /// The first point.
  explicit WeightedLattice(Site site = {0, 0});

  /// Another point at `site`, which is free and beside that of point `neighbour`; their edge weighs
  /// `weight`. Returns its number.
  PoolIndex add(Site site, PoolIndex neighbour, double weight);

  /// A row of points to the right of (or above, ...) point `first`; `weights` are those of the
  /// edges from each to the next. Returns the last.
  PoolIndex add_row(PoolIndex first, Site direction, std::span<const double> weights);

  [[nodiscard]] PoolIndex size() const { return static_cast<PoolIndex>(points_.size()); }
  [[nodiscard]] const std::vector<CloudPoint>& points() const { return points_; }

 private:
  PoolIndex add_point(Site site, double length);

  std::vector<Site> sites_;
  std::set<std::pair<int, int>> taken_;
  std::vector<CloudPoint> points_;
};

/// Points in a row; `weights` are those of the edges from each to the next.
std::vector<CloudPoint> chain_of_weights(std::span<const double> weights);

}  // namespace kintsugi::segmenter::fuzz
