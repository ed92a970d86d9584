#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "segmenter/core/batch/segment_forest.hpp"
#include "segmenter/core/graph/edge.hpp"
#include "segmenter/core/graph/edge_buckets.hpp"

namespace kintsugi::segmenter {

/// Called for each edge between two different segments, in the order in which edges are decided.
class JoinObserver {
 public:
  virtual ~JoinObserver() = default;
  /// `host` and `guest` were the roots of the two segments. `host` stays a root.
  virtual void joined(const Edge& /*edge*/, PointIndex /*host*/, PointIndex /*guest*/) {}
  virtual void rejected(const Edge& /*edge*/) {}
};

/// Appends the edges between two different segments to `between`. Most edges lie inside a segment
/// when their turn comes, and need not be sorted.
inline void append_edges_between_segments(std::span<const Edge> edges, SegmentForest& forest,
                                          std::vector<Edge>& between) {
  constexpr std::size_t kAhead = 16;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    if (k + kAhead < edges.size()) {
      forest.prefetch(edges[k + kAhead].i);
      forest.prefetch(edges[k + kAhead].j);
    }
    if (forest.find(edges[k].i) != forest.find(edges[k].j)) between.push_back(edges[k]);
  }
}

/// Algorithm 1, lines 6-13: sorts `edges` (AscendingWeight) and joins the segments of each edge if
/// both are alive. Returns the number of joins. `observer` is a JoinObserver or has its functions.
template <typename Observer>
std::int64_t join_in_order(std::span<Edge> edges, SegmentForest& forest, Observer&& observer) {
  std::int64_t num_joins = 0;
  std::sort(edges.begin(), edges.end(), AscendingWeight());
  constexpr std::size_t kAhead = 16;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    if (k + kAhead < edges.size()) {
      forest.prefetch(edges[k + kAhead].i);
      forest.prefetch(edges[k + kAhead].j);
    }
    const Edge& edge = edges[k];
    PointIndex host = forest.find(edge.i);
    PointIndex guest = forest.find(edge.j);
    if (host == guest) continue;
    if (forest.join_roots(host, guest, edge.weight)) {
      observer.joined(edge, host, guest);
      ++num_joins;
    } else {
      observer.rejected(edge);
    }
  }
  return num_joins;
}

/// As join_in_order(). Where there are many edges, they are sorted bucket by bucket.
template <typename Observer>
std::int64_t join_segments(std::span<const Edge> edges, SegmentForest& forest,
                           Observer&& observer) {
  constexpr std::size_t kFewEdges = 50'000;
  if (edges.size() < kFewEdges) {
    std::vector<Edge> copy(edges.begin(), edges.end());
    return join_in_order(std::span(copy), forest, observer);
  }
  EdgeBuckets buckets;
  for (const Edge& edge : edges) buckets.add(edge);
  std::int64_t num_joins = 0;
  std::vector<Edge> between;
  for (std::size_t b = 0; b < EdgeBuckets::kNumBuckets; ++b) {
    between.clear();
    buckets.take(b, [&](std::span<const Edge> some) {
      append_edges_between_segments(some, forest, between);
    });
    num_joins += join_in_order(std::span(between), forest, observer);
  }
  return num_joins;
}

inline std::int64_t join_segments(std::span<const Edge> edges, SegmentForest& forest) {
  struct {
    void joined(const Edge& /*edge*/, PointIndex /*host*/, PointIndex /*guest*/) const {}
    void rejected(const Edge& /*edge*/) const {}
  } no_observer;
  return join_segments(edges, forest, no_observer);
}

}  // namespace kintsugi::segmenter
