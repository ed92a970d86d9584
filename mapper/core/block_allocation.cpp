#include "mapper/core/block_allocation.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

namespace kintsugi::mapper {
namespace {

using BlockCoords = std::vector<BlockCoord>;

/// A block is 8 voxels wide and seen through many pixels: every other one finds them all.
constexpr int kPixelStride = 2;

/// Walks the part of a ray within the truncation distance of a depth, in steps of half a block.
class BandWalker {
 public:
  BandWalker(const CameraView& view, const TsdfVolume& volume)
      : volume_(volume), blocks_per_m_(1.0F / (volume.resolution_m() * kBlockSide)) {
    const float half_blocks = volume.truncation_m() * blocks_per_m_ * 2.0F;
    half_steps_ = static_cast<int>(std::ceil(half_blocks - 1e-3F));
    step_m_ = volume.truncation_m() / static_cast<float>(half_steps_);
    camera_blocks_ = view.t_WC * blocks_per_m_;
  }

  /// Appends the blocks that do not exist yet; some of them more than once.
  void append_missing(const Eigen::Vector3f& ray_W, float depth_m, BlockCoords& missing) const {
    const Eigen::Vector3f ray_blocks = ray_W * blocks_per_m_;
    for (int step = -half_steps_; step <= half_steps_; ++step) {
      const float z_m = depth_m + static_cast<float>(step) * step_m_;
      const Eigen::Vector3f point = camera_blocks_ + ray_blocks * z_m;
      const BlockCoord coord =
          make_block_coord(floor_int(point.x()), floor_int(point.y()), floor_int(point.z()));
      if (!volume_.contains(coord) || volume_.find(coord) != kNoBlock) continue;
      const auto recent = missing.end() - std::min<std::ptrdiff_t>(8, std::ssize(missing));
      if (std::find(recent, missing.end(), coord) == missing.end()) missing.push_back(coord);
    }
  }

 private:
  static int floor_int(float value) {
    const int truncated = static_cast<int>(value);
    return truncated - static_cast<int>(static_cast<float>(truncated) > value);
  }

  const TsdfVolume& volume_;
  float blocks_per_m_;
  int half_steps_ = 0;
  float step_m_ = 0.0F;
  Eigen::Vector3f camera_blocks_;
};

BlockCoords find_missing_blocks(const cv::Mat_<float>& depth_m, const CameraView& view,
                                float min_depth_m, float max_depth_m, const TsdfVolume& volume) {
  const BandWalker walker(view, volume);
  tbb::enumerable_thread_specific<BlockCoords> found;
  const int num_rows = (view.height + kPixelStride - 1) / kPixelStride;
  tbb::parallel_for(tbb::blocked_range<int>(0, num_rows, 16), [&](const auto& rows) {
    BlockCoords& missing = found.local();
    for (int row = rows.begin(); row < rows.end(); ++row) {
      const int v = row * kPixelStride;
      const float* depth_row = depth_m[v];
      for (int u = 0; u < view.width; u += kPixelStride) {
        const float depth = depth_row[u];
        if (!(depth >= min_depth_m && depth <= max_depth_m)) continue;
        const Eigen::Vector3f ray_C = view.ray_C(static_cast<float>(u), static_cast<float>(v));
        walker.append_missing(view.R_WC * ray_C, depth, missing);
      }
    }
  });
  BlockCoords all;
  for (const BlockCoords& part : found) all.insert(all.end(), part.begin(), part.end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

}  // namespace

void allocate_seen_blocks(const cv::Mat_<float>& depth_m, const CameraView& view, float min_depth_m,
                          float max_depth_m, TsdfVolume& volume) {
  for (const BlockCoord& coord :
       find_missing_blocks(depth_m, view, min_depth_m, max_depth_m, volume)) {
    volume.allocate(coord);
  }
}

}  // namespace kintsugi::mapper
