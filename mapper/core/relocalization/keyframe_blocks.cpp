#include "mapper/core/relocalization/keyframe_blocks.hpp"

namespace kintsugi::mapper {
namespace {

constexpr int kSampleStep_px = 16;

}  // namespace

std::vector<BlockCoord> blocks_seen_from(const Keyframe& keyframe, double resolution_m) {
  const double block_m = kBlockSide * resolution_m;
  std::vector<BlockCoord> blocks;
  for (int v = kSampleStep_px / 2; v < keyframe.camera.height; v += kSampleStep_px) {
    for (int u = kSampleStep_px / 2; u < keyframe.camera.width; u += kSampleStep_px) {
      if (!(keyframe.depth_m(v, u) > 0.0)) continue;
      const Eigen::Vector3d p_U = keyframe.X_WC * keyframe.point(v, u);
      const Eigen::Vector3i block = (p_U / block_m).array().floor().cast<int>();
      blocks.push_back(make_block_coord(block.x(), block.y(), block.z()));
    }
  }
  return blocks;
}

}  // namespace kintsugi::mapper
