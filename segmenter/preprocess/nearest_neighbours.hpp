#pragma once
// The k nearest neighbours of points, by FLANN.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

/// An exact k-d tree over the positions of a cloud. Queries may run in several threads.
class NearestNeighbours {
 public:
  /// @param points_W all with finite positions; need not outlive this
  explicit NearestNeighbours(std::span<const CloudPoint> points_W);
  ~NearestNeighbours();
  NearestNeighbours(const NearestNeighbours&) = delete;
  NearestNeighbours& operator=(const NearestNeighbours&) = delete;

  struct Result {
    int count = 0;                         ///< neighbours found for each query: min(k, cloud size)
    std::vector<std::uint32_t> indices;    ///< `count` for each query, nearest first
    std::vector<float> squared_distances;  ///< m^2, in the same order
  };

  /// The k points nearest to each query, itself included when it is in the cloud.
  void find(std::span<const CloudPoint> queries_W, int k, Result& result) const;

  [[nodiscard]] std::size_t size() const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

/// Median distance of a point to the nearest other place that holds one: what a cloud's voxel size
/// is taken for when nobody says it. At most 100,000 points, evenly spread over the cloud's order,
/// are asked. Points that coincide with all their 8 neighbours do not count; 0: nothing to go by.
float median_spacing_m(std::span<const CloudPoint> points_W);

}  // namespace kintsugi::segmenter
