#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapper/core/extraction/padded_block.hpp"

namespace kintsugi::mapper {

/// Between which neighbouring voxels a change of sign is surface.
///
/// At the outline of an object the voxels behind its surface lie next to free space that the camera
/// saw past it: the sign changes there, too, although there is no surface. This shows as a jump of
/// the distance from one voxel to the next, by up to the whole truncation band. Across a surface
/// the distance changes by one voxel over the cosine of the angle at which the surface was seen.
struct CrossingRule {
  int weight_threshold = 0;  ///< both voxels have more observations than this
  int max_step_raw = 0;      ///< and their distances differ by no more than this

  /// For blocks whose distances are fractions of `truncation_m`.
  CrossingRule(int weight_threshold, double max_step_vox, double resolution_m, double truncation_m);
};

/// The surface points of a block, at most one in each voxel, in the order of the voxels.
class BlockPoints {
 public:
  struct Point {
    Eigen::Vector3f offset_vox;  ///< from the centre of its voxel
    Eigen::Vector3f normal_W;    ///< unit, the gradient of the distance at the point
  };

  BlockPoints() = default;
  BlockPoints(const PaddedBlock& block, const CrossingRule& rule);

  bool empty() const { return points_.empty(); }
  const std::vector<Point>& points() const { return points_; }

  /// Bit x is set where voxel x of the row has a point; rows are numbered z * 8 + y.
  unsigned row_mask(int row) const { return row_masks_[row]; }
  /// The first point of a row.
  const Point* row_points(int row) const { return points_.data() + row_starts_[row]; }

 private:
  std::vector<Point> points_;
  static constexpr std::size_t kNumRows = std::size_t{kBlockSide} * kBlockSide;
  std::array<std::uint8_t, kNumRows> row_masks_{};
  std::array<std::uint16_t, kNumRows> row_starts_{};
};

/// Whether a block has voxels with more observations than the threshold on either side of the
/// surface.
struct ObservedSides {
  bool free_space = false;
  bool behind = false;
};
ObservedSides observed_sides(const VoxelBlock& block, int weight_threshold);

}  // namespace kintsugi::mapper
