#include "segmenter/core/felzenszwalb.hpp"

#include <bit>

namespace kintsugi::segmenter {
namespace {

// The upper half of a float32 that is not negative orders as its value does: 128 buckets for each
// power of two, fine where most weights are, from squared ones near zero up to T + k.
constexpr std::size_t kNumBuckets = std::size_t{1} << 15;

std::size_t bucket_of(const Edge& edge) { return std::bit_cast<std::uint32_t>(edge.weight) >> 16; }

struct Unobserved {
  void joined(const Edge& /*edge*/, PointIndex /*host*/, PointIndex /*guest*/) const {}
  void rejected(const Edge& /*edge*/) const {}
};

}  // namespace

EdgeBuckets::EdgeBuckets(std::span<const Edge> unsorted)
    : edges(unsorted.size()), first(kNumBuckets + 1, 0) {
  for (const Edge& edge : unsorted) ++first[bucket_of(edge) + 1];
  for (std::size_t b = 0; b < kNumBuckets; ++b) first[b + 1] += first[b];
  std::vector<std::size_t> next = first;
  for (const Edge& edge : unsorted) edges[next[bucket_of(edge)]++] = edge;
}

std::int64_t join_segments(std::span<const Edge> edges, SegmentForest& forest) {
  return join_segments(edges, forest, Unobserved());
}

}  // namespace kintsugi::segmenter
