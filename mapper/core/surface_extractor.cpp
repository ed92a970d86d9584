#include "mapper/core/surface_extractor.hpp"

#include <algorithm>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include "mapper/core/block_surface.hpp"
#include "mapper/core/check.hpp"
#include "mapper/core/detached_blocks.hpp"
#include "mapper/core/padded_block.hpp"

namespace kintsugi::mapper {
namespace {

bool has_observed(const VoxelBlock& block, int weight_threshold) {
  return std::any_of(block.voxels.begin(), block.voxels.end(), [weight_threshold](Voxel voxel) {
    return voxel_weight(voxel) > weight_threshold;
  });
}

CloudPoint make_point(const BlockSurface::Point& point, const Eigen::Vector3f& normal_W,
                      const DetachedBlocks& blocks, std::size_t block) {
  const BlockCoord& coord = blocks.coords[block];
  const Eigen::Vector3d corner_vox = Eigen::Vector3d(coord.x, coord.y, coord.z) * kBlockSide;
  const Eigen::Vector3f position_W =
      ((corner_vox + point.position_vox.cast<double>()) * blocks.resolution_m).cast<float>();
  const int voxel = voxel_index(point.voxel[0], point.voxel[1], point.voxel[2]);
  const VoxelColor color = blocks.colors[block]->colors[voxel];
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
  result.weight = static_cast<float>(voxel_weight(blocks.voxels[block]->voxels[voxel]));
  return result;
}

}  // namespace

void SurfaceExtractor::Config::validate() const {
  check_range("weight_threshold", weight_threshold, 0, 65534);
  check_range("normal_radius_vox", normal_radius_vox, 0.0, 2.0);
}

SurfaceExtractor::SurfaceExtractor(const Config& config) : config_(config) { config_.validate(); }

std::vector<CloudPoint> SurfaceExtractor::extract(const DetachedBlocks& blocks) const {
  const auto radius_vox = static_cast<float>(config_.normal_radius_vox);
  std::vector<std::vector<CloudPoint>> points_of(blocks.coords.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, blocks.coords.size(), 16),
                    [&](const auto& range) {
                      for (std::size_t block = range.begin(); block < range.end(); ++block) {
                        if (!has_observed(*blocks.voxels[block], config_.weight_threshold))
                          continue;
                        const BlockSurface surface(PaddedBlock(blocks, blocks.coords[block]),
                                                   config_.weight_threshold);
                        for (const BlockSurface::Point& point : surface.points()) {
                          if (!BlockSurface::is_in_block(point)) continue;
                          const Eigen::Vector3f normal_W = surface.mean_normal(point, radius_vox);
                          points_of[block].push_back(make_point(point, normal_W, blocks, block));
                        }
                      }
                    });
  std::vector<CloudPoint> points;
  for (const auto& part : points_of) points.insert(points.end(), part.begin(), part.end());
  return points;
}

}  // namespace kintsugi::mapper
