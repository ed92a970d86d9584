#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "segmenter/core/point_cloud.hpp"

namespace kintsugi::segmenter {

/// Disjoint sets of points, each with its size and its join threshold theta (Eq. 3): the state of
/// Algorithm 1. `threshold` is T, `scale` is k.
class SegmentForest {
 public:
  SegmentForest(double threshold, double scale) : threshold_(threshold), scale_(scale) {}

  /// Adds singletons until there are `num_points` points.
  void grow(PointIndex num_points) {
    for (PointIndex i = size(); i < num_points; ++i) {
      parents_.push_back(i);
      sets_.push_back({threshold_, 1});
    }
  }
  PointIndex size() const { return static_cast<PointIndex>(parents_.size()); }

  /// Makes `point` a segment of its own (Algorithm 1, line 4). Its whole set must be reset so, or
  /// the points left behind would still hang on it.
  void reset(PointIndex point) {
    parents_[point] = point;
    sets_[point] = {threshold_, 1};
  }

  /// Puts `point`, a singleton, into the set of `root`, which has this theta: a set that was saved.
  void restore(PointIndex point, PointIndex root, double theta) {
    parents_[point] = root;
    if (point != root) ++sets_[root].size;
    sets_[root].theta = theta;
  }

  PointIndex find(PointIndex point) {
    while (parents_[point] != point) {
      parents_[point] = parents_[parents_[point]];
      point = parents_[point];
    }
    return point;
  }
  /// As find(), without shortening the paths.
  PointIndex root(PointIndex point) const {
    while (parents_[point] != point) point = parents_[point];
    return point;
  }

  /// theta of the segment of `root`, a result of find().
  double theta_at(PointIndex root) const { return sets_[root].theta; }

  /// Joins the segments of i and j if they are two and `weight` is below both thresholds
  /// (Algorithm 1, lines 7-11); tells whether it did.
  bool join(PointIndex i, PointIndex j, float weight) {
    PointIndex host = find(i);
    PointIndex guest = find(j);
    return host != guest && join_roots(host, guest, weight);
  }
  /// As join(), for two different roots. Where it joins, `host` is the one that stays a root: that
  /// of the larger segment, the first of the two when they are equal.
  bool join_roots(PointIndex& host, PointIndex& guest, float weight) {
    const double w = weight;
    if (!(w < sets_[host].theta && w < sets_[guest].theta)) return false;
    if (sets_[host].size < sets_[guest].size) std::swap(host, guest);
    parents_[guest] = host;
    sets_[host].size += sets_[guest].size;
    sets_[host].theta = w + scale_ / sets_[host].size;
    return true;
  }

  std::size_t bytes() const {
    return parents_.capacity() * sizeof(PointIndex) + sets_.capacity() * sizeof(Set);
  }

 private:
  struct Set {
    double theta;
    std::uint32_t size;
  };

  double threshold_;
  double scale_;
  std::vector<PointIndex> parents_;
  std::vector<Set> sets_;  ///< valid at roots
};

}  // namespace kintsugi::segmenter
