#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "lcmtypes/base/growing_array.hpp"
#include "segmenter/core/graph/edge.hpp"

namespace kintsugi::segmenter {

/// Edges in buckets of ascending weight, in any order within a bucket. A bucket is a chain of
/// chunks, so that it grows without copying.
class EdgeBuckets {
 public:
  // The upper bits of a float32 >= 0 are ordered as its value. 64 buckets for each power of two are
  // fine enough for weights from nearly zero up to T + k.
  static constexpr int kShift = 17;
  static constexpr std::size_t kNumBuckets = std::size_t{1} << (31 - kShift);

  static std::size_t bucket_of(float weight) {
    return std::bit_cast<std::uint32_t>(weight) >> kShift;
  }

  EdgeBuckets() : buckets_(kNumBuckets) {}

  void add(const Edge& edge) {
    Bucket& bucket = buckets_[bucket_of(edge.weight)];
    if (bucket.room == 0) start_chunk(bucket);
    --bucket.room;
    edges_[bucket.chunk * kChunkEdges + bucket.room] = edge;
  }

  /// Removes the edges of a bucket: calls fn(std::span<const Edge>) for each part of them.
  template <typename Fn>
  void take(std::size_t index, Fn&& fn) {
    Bucket bucket = std::exchange(buckets_[index], {});
    while (bucket.chunk != kNoChunk) {
      fn(edges_.span().subspan(bucket.chunk * kChunkEdges, kChunkEdges).subspan(bucket.room));
      free_.push_back(bucket.chunk);
      bucket = {.chunk = previous_[bucket.chunk], .room = 0};
    }
  }

 private:
  static constexpr std::size_t kChunkEdges = 256;
  static constexpr std::uint32_t kNoChunk = UINT32_MAX;

  struct Bucket {
    std::uint32_t chunk = kNoChunk;  ///< the last one, which is filled from its end
    std::uint32_t room = 0;          ///< free places in it
  };

  void start_chunk(Bucket& bucket) {
    std::uint32_t chunk = 0;
    if (free_.empty()) {
      chunk = static_cast<std::uint32_t>(previous_.size());
      previous_.push_back(kNoChunk);
      edges_.resize(edges_.size() + kChunkEdges);
    } else {
      chunk = free_.back();
      free_.pop_back();
    }
    previous_[chunk] = bucket.chunk;
    bucket = {.chunk = chunk, .room = kChunkEdges};
  }

  std::vector<Bucket> buckets_;
  GrowingArray<Edge> edges_;             ///< chunk after chunk
  std::vector<std::uint32_t> previous_;  ///< by chunk: the chunk before it in its bucket
  std::vector<std::uint32_t> free_;      ///< chunks to use again
};

}  // namespace kintsugi::segmenter
