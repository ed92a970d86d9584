#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "segmenter/core/edge.hpp"

namespace kintsugi::segmenter {

/// Edges roughly sorted as they are found: into buckets of ascending weight, in any order within.
class EdgeBuckets {
 public:
  // The upper bits of a float32 that is not negative order as its value does. 64 buckets for each
  // power of two, fine where most weights are, from squared ones near zero up to T + k.
  static constexpr int kShift = 17;
  static constexpr std::size_t kNumBuckets = std::size_t{1} << (31 - kShift);

  static std::size_t bucket_of(float weight) {
    return std::bit_cast<std::uint32_t>(weight) >> kShift;
  }

  EdgeBuckets() : buckets_(kNumBuckets) {}

  void add(const Edge& edge) { buckets_[bucket_of(edge.weight)].push_back(edge); }

  std::vector<Edge>& operator[](std::size_t bucket) { return buckets_[bucket]; }

 private:
  std::vector<std::vector<Edge>> buckets_;
};

}  // namespace kintsugi::segmenter
