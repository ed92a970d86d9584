#pragma once
// The k nearest neighbours of points (FLANN).

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

/// The spacing of points on their surfaces, which serves as voxel size of a cloud if none is given:
/// the side of the square of surface for each point. It is computed from the disc that contains 12
/// neighbours (as many as a point of a square grid has within 2 steps), as the median over at most
/// 100,000 points that are evenly spread over the order of the cloud. The distance to the nearest
/// point would not do: a voxel whose x, y and z edges are all crossed has three points close
/// together. 0 for clouds of 12 points or fewer.
float median_spacing_m(std::span<const CloudPoint> points_W);

}  // namespace kintsugi::segmenter
