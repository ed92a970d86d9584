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

/// Spacing of the points on their surfaces, what a cloud's voxel size is taken for when nobody says
/// it: the side of the square that one point has to itself, by the disc that holds 12 neighbours
/// (as many as a point of a square grid has within 2 steps); the median over at most 100,000
/// points, evenly spread over the cloud's order. The distance to the nearest point alone would
/// mislead: a voxel that is crossed in x, y and z holds three points close together. 0: nothing to
/// go by.
float median_spacing_m(std::span<const CloudPoint> points_W);

}  // namespace kintsugi::segmenter
