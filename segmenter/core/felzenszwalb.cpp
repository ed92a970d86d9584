#include "segmenter/core/felzenszwalb.hpp"

#include <algorithm>
#include <bit>
#include <vector>

namespace kintsugi::segmenter {
namespace {

// The upper half of a float32 that is not negative orders as its value does: 256 buckets for each
// power of two, fine where most weights are, from squared ones near zero up to T + k.
constexpr std::size_t kNumBuckets = std::size_t{1} << 15;

std::size_t bucket_of(const Edge& edge) { return std::bit_cast<std::uint32_t>(edge.weight) >> 16; }

/// The edges by bucket, and where each bucket begins.
struct Buckets {
  explicit Buckets(std::span<const Edge> unsorted)
      : edges(unsorted.size()), first(kNumBuckets + 1, 0) {
    for (const Edge& edge : unsorted) ++first[bucket_of(edge) + 1];
    for (std::size_t b = 0; b < kNumBuckets; ++b) first[b + 1] += first[b];
    std::vector<std::size_t> next = first;
    for (const Edge& edge : unsorted) edges[next[bucket_of(edge)]++] = edge;
  }

  std::vector<Edge> edges;
  std::vector<std::size_t> first;
};

}  // namespace

std::int64_t join_segments(std::span<const Edge> edges, SegmentForest& forest) {
  Buckets buckets(edges);
  std::int64_t num_joins = 0;
  for (std::size_t b = 0; b < kNumBuckets; ++b) {
    // Most edges lie inside a segment when their turn comes: only the others are sorted.
    Edge* const first = buckets.edges.data() + buckets.first[b];
    Edge* const last =
        std::remove_if(first, buckets.edges.data() + buckets.first[b + 1],
                       [&](const Edge& e) { return forest.find(e.i) == forest.find(e.j); });
    std::sort(first, last, AscendingWeight());
    for (const Edge* e = first; e != last; ++e) num_joins += forest.join(e->i, e->j, e->weight);
  }
  return num_joins;
}

}  // namespace kintsugi::segmenter
