#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "segmenter/core/edge.hpp"
#include "segmenter/core/segment_forest.hpp"

namespace kintsugi::segmenter {

/// Edges sorted roughly: bucket after bucket in ascending order of weight, in any order within.
struct EdgeBuckets {
  explicit EdgeBuckets(std::span<const Edge> unsorted);

  std::size_t size() const { return first.size() - 1; }
  std::span<Edge> operator[](std::size_t b) {
    return std::span(edges).subspan(first[b], first[b + 1] - first[b]);
  }

  std::vector<Edge> edges;
  std::vector<std::size_t> first;  ///< where each bucket begins, and the end
};

/// Algorithm 1, lines 6-13: takes the edges in ascending order (AscendingWeight) and joins what may
/// be joined; `edges` come in any order. Returns the number of joins.
///
/// Tells `observer`, in the order of the edges, of each edge between two segments:
///   joined(const Edge&, PointIndex host, PointIndex guest)  the roots; the host's stays the root
///   rejected(const Edge&)
/// Edges within one segment are passed over.
template <typename Observer>
std::int64_t join_segments(std::span<const Edge> edges, SegmentForest& forest,
                           Observer&& observer) {
  EdgeBuckets buckets(edges);
  std::int64_t num_joins = 0;
  for (std::size_t b = 0; b < buckets.size(); ++b) {
    // Most edges lie inside a segment when their turn comes: only the others are sorted.
    const std::span<Edge> bucket = buckets[b];
    const auto last = std::remove_if(bucket.begin(), bucket.end(), [&](const Edge& e) {
      return forest.find(e.i) == forest.find(e.j);
    });
    std::sort(bucket.begin(), last, AscendingWeight());
    for (auto e = bucket.begin(); e != last; ++e) {
      PointIndex host = forest.find(e->i);
      PointIndex guest = forest.find(e->j);
      if (host == guest) continue;
      if (forest.join_roots(host, guest, e->weight)) {
        observer.joined(*e, host, guest);
        ++num_joins;
      } else {
        observer.rejected(*e);
      }
    }
  }
  return num_joins;
}

/// As above, unobserved.
std::int64_t join_segments(std::span<const Edge> edges, SegmentForest& forest);

}  // namespace kintsugi::segmenter
