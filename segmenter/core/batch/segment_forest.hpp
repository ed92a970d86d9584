#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>

#include "lcmtypes/base/growing_array.hpp"
#include "segmenter/core/points/point_cloud.hpp"

namespace kintsugi::segmenter {

/// The state of Algorithm 1: disjoint sets of points (segments), each with its size and its join
/// threshold theta (Eq. 3). `threshold` is T, `scale` is k.
class SegmentForest {
 public:
  SegmentForest(double threshold, double scale) : threshold_(threshold), scale_(scale) {}

  /// Adds singletons until there are `num_points` points.
  void grow(PointIndex num_points) {
    for (PointIndex i = size(); i < num_points; ++i) {
      nodes_.push_back({threshold_, 1, i});
    }
  }
  PointIndex size() const { return static_cast<PointIndex>(nodes_.size()); }

  /// Makes `point` a segment of its own (Algorithm 1, line 4). All points of its old segment must
  /// be reset, because some may have it as parent.
  void reset(PointIndex point) { nodes_[point] = {threshold_, 1, point}; }

  /// Restores a saved segment: puts `point`, a singleton, into that of `root`, which has this
  /// theta.
  void restore(PointIndex point, PointIndex root, double theta) {
    nodes_[point].parent = root;
    if (point != root) ++nodes_[root].size;
    nodes_[root].theta = theta;
  }

  PointIndex find(PointIndex point) {
    while (nodes_[point].parent != point) {
      nodes_[point].parent = nodes_[nodes_[point].parent].parent;
      point = nodes_[point].parent;
    }
    return point;
  }
  /// To be called some time before find(point), so that the memory is in the cache.
  void prefetch(PointIndex point) const { __builtin_prefetch(&nodes_[point]); }
  /// As find(), without shortening the paths.
  PointIndex root(PointIndex point) const {
    while (nodes_[point].parent != point) point = nodes_[point].parent;
    return point;
  }

  /// Points of the segment of `root`; if that has joined another one, the points it had then.
  std::uint32_t size_at(PointIndex root) const { return nodes_[root].size; }

  /// theta of the segment of `root`, a result of find().
  double theta_at(PointIndex root) const { return nodes_[root].theta; }

  /// Joins the segments of i and j if they are different and `weight` is below both thresholds
  /// (Algorithm 1, lines 7-11). Returns whether it did.
  bool join(PointIndex i, PointIndex j, float weight) {
    PointIndex host = find(i);
    PointIndex guest = find(j);
    return host != guest && join_roots(host, guest, weight);
  }
  /// As join(), for two different roots. If it joins, they are swapped as needed so that `host` is
  /// the one that stays a root: that of the larger segment, or the first one if they are equal.
  bool join_roots(PointIndex& host, PointIndex& guest, float weight) {
    const double w = weight;
    if (!(w < nodes_[host].theta && w < nodes_[guest].theta)) return false;
    if (nodes_[host].size < nodes_[guest].size) std::swap(host, guest);
    nodes_[guest].parent = host;
    nodes_[host].size += nodes_[guest].size;
    nodes_[host].theta = w + scale_ / nodes_[host].size;
    return true;
  }

  std::size_t bytes() const { return nodes_.bytes(); }

 private:
  struct Node {
    double theta;  ///< theta and size are of the segment of which it is, or was, the root
    std::uint32_t size;
    PointIndex parent;  ///< itself: a root
  };

  double threshold_;
  double scale_;
  GrowingArray<Node> nodes_;
};

}  // namespace kintsugi::segmenter
