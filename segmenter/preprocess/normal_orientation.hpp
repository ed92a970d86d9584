#pragma once
// Orients normals of unknown sign consistently.

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

/// The nearest neighbours of each point, up to kDegree.
class NeighbourGraph {
 public:
  static constexpr std::size_t kDegree = 8;

  explicit NeighbourGraph(std::size_t num_points) : neighbours_(num_points) {}

  /// Keeps the first kDegree; different points may be set by different threads.
  void set_neighbours(std::size_t point, std::span<const std::uint32_t> neighbours) {
    neighbours_[point].fill(static_cast<std::uint32_t>(point));
    std::copy_n(neighbours.begin(), std::min(kDegree, neighbours.size()),
                neighbours_[point].begin());
  }
  /// kDegree entries; the point itself where there are fewer.
  [[nodiscard]] std::span<const std::uint32_t> neighbours_of(std::size_t point) const {
    return neighbours_[point];
  }

 private:
  std::vector<std::array<std::uint32_t, kDegree>> neighbours_;
};

/// Flips normals so that they agree along a minimum spanning forest of `graph` (edges cost
/// 1 - |n_i . n_j|), then each tree as a whole so that most of its normals face `viewpoint_W`.
/// Normals that are zero stay zero.
void orient_normals(std::span<CloudPoint> points_W, const NeighbourGraph& graph,
                    const Eigen::Vector3d& viewpoint_W);

}  // namespace kintsugi::segmenter
