#include "mapper/core/extraction/surface_extractor.hpp"

#include <array>

#include "lcmtypes/base/argument_check.hpp"
#include "mapper/core/extraction/block_points.hpp"
#include "mapper/core/extraction/normal_averaging.hpp"
#include "mapper/core/extraction/padded_block.hpp"
#include "mapper/core/extraction/slice_blocks.hpp"
#include "mapper/core/volume/detached_blocks.hpp"

namespace kintsugi::mapper {
namespace {

/// The points of each block before their normals are averaged. Only the blocks near the current
/// position are kept, so that memory does not grow with the size of the slice.
class PointsAhead {
 public:
  PointsAhead(const SliceBlocks& blocks, const CrossingRule& rule)
      : blocks_(blocks), rule_(rule), walk_(blocks), sides_(blocks.size()), points_(blocks.size()) {
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      sides_[i] = observed_sides(*blocks[i].voxels, rule.weight_threshold);
    }
  }

  /// Computes the points of all blocks that touch layer z of blocks, and drops those that no later
  /// layer touches.
  void advance_to(int z) {
    for (; num_ready_ < blocks_.size() && blocks_[num_ready_].coord.z <= z + 1; ++num_ready_) {
      const BlockNeighbors neighbors = walk_.around(num_ready_);
      if (!may_have_points(neighbors)) continue;
      points_[num_ready_] = BlockPoints(PaddedBlock(blocks_, neighbors), rule_);
    }
    for (; blocks_[num_dropped_].coord.z < z - 1; ++num_dropped_) points_[num_dropped_] = {};
  }

  const BlockPoints* find(int index) const {
    return index == kNoNeighbor || points_[index].empty() ? nullptr : &points_[index];
  }

 private:
  /// Whether there is surface in the block or between it and a block that shares a face with it.
  bool may_have_points(const BlockNeighbors& neighbors) const {
    const ObservedSides own = sides_[neighbors[neighbor_index(0, 0, 0)]];
    if (own.free_space && own.behind) return true;
    if (!own.free_space && !own.behind) return false;
    for (const int face :
         {neighbor_index(-1, 0, 0), neighbor_index(1, 0, 0), neighbor_index(0, -1, 0),
          neighbor_index(0, 1, 0), neighbor_index(0, 0, -1), neighbor_index(0, 0, 1)}) {
      if (neighbors[face] == kNoNeighbor) continue;
      const ObservedSides other = sides_[neighbors[face]];
      if (own.free_space ? other.behind : other.free_space) return true;
    }
    return false;
  }

  const SliceBlocks& blocks_;
  CrossingRule rule_;
  NeighborWalk walk_;
  std::vector<ObservedSides> sides_;
  std::vector<BlockPoints> points_;
  std::size_t num_ready_ = 0;
  std::size_t num_dropped_ = 0;
};

CloudPoint make_point(const PaddedPoints::Point& point, int voxel, const Eigen::Vector3f& normal_W,
                      const SliceBlocks::Block& block, float resolution_m) {
  const auto& p = point.position_vox;
  const Eigen::Vector3d corner_vox =
      Eigen::Vector3d(block.coord.x, block.coord.y, block.coord.z) * kBlockSide;
  const Eigen::Vector3f position_W =
      ((corner_vox + Eigen::Vector3d(p[0], p[1], p[2])) * resolution_m).cast<float>();
  const VoxelColor color = block.colors->colors[voxel];
  CloudPoint result;
  result.x = position_W.x();
  result.y = position_W.y();
  result.z = position_W.z();
  result.nx = normal_W.x();
  result.ny = normal_W.y();
  result.nz = normal_W.z();
  result.red = static_cast<std::uint8_t>(color & 0xFFU);
  result.green = static_cast<std::uint8_t>((color >> 8) & 0xFFU);
  result.blue = static_cast<std::uint8_t>((color >> 16) & 0xFFU);
  result.weight = static_cast<float>(voxel_weight(block.voxels->voxels[voxel]));
  return result;
}

}  // namespace

void SurfaceExtractor::Config::validate() const {
  check_range("weight_threshold", weight_threshold, 0, 65534);
  check_range("max_step_vox", max_step_vox, 1.0, 100.0);
  check_range("normal_radius_vox", normal_radius_vox, 0.0, 2.0);
}

SurfaceExtractor::SurfaceExtractor(const Config& config) : config_(config) { config_.validate(); }

ExtractedSurface SurfaceExtractor::extract_blocks(const DetachedBlocks& detached) const {
  const auto radius_vox = static_cast<float>(config_.normal_radius_vox);
  const SliceBlocks blocks(detached);
  PointsAhead ahead(blocks, CrossingRule(config_.weight_threshold, config_.max_step_vox,
                                         detached.resolution_m, detached.truncation_m));
  NeighborWalk walk(blocks);
  PaddedPoints padded;
  ExtractedSurface surface;
  std::vector<CloudPoint>& cloud = surface.points_W;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const SliceBlocks::Block& block = blocks[i];
    if (!block.is_own) continue;
    ahead.advance_to(block.coord.z);
    if (ahead.find(static_cast<int>(i)) == nullptr) continue;
    std::array<const BlockPoints*, 27> around{};
    const BlockNeighbors neighbors = walk.around(i);
    for (int k = 0; k < 27; ++k) around[k] = ahead.find(neighbors[k]);
    padded.assign(around);
    const std::size_t first_point = cloud.size();
    padded.for_each_in_block(radius_vox, [&](const PaddedPoints::Point& point, int x, int y, int z,
                                             const Eigen::Vector3f& normal_W) {
      cloud.push_back(
          make_point(point, voxel_index(x, y, z), normal_W, block, detached.resolution_m));
    });
    if (cloud.size() > first_point) {
      surface.blocks.push_back({block.coord, first_point, cloud.size() - first_point});
    }
  }
  return surface;
}

}  // namespace kintsugi::mapper
