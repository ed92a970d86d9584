#include "mapper/core/fusion/block_allocation.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <vector>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

#include "mapper/core/volume/kernel_arguments.hpp"

namespace kintsugi::mapper {
namespace {

/// As the kernels pack them.
using PackedBlocks = std::vector<std::uint32_t>;

/// A block is 8 voxels wide and seen through many pixels: every other one finds them all.
constexpr int kPixelStride = 2;

/// The rays within the truncation distance of their depths, in steps of at most half a block.
AllocationView make_allocation_view(const cv::Mat_<float>& depth_m, const Intrinsics& intrinsics,
                                    const Pose& X_WC, const TsdfVolume& volume) {
  const double block_m = volume.config().resolution_m * kBlockSide;
  const BlockCoord& min = volume.min_block();
  const Eigen::Vector3d origin_blocks =
      X_WC.translation() / block_m - Eigen::Vector3d(min.x, min.y, min.z);
  const double half_blocks = volume.truncation_m() / block_m * 2.0;
  AllocationView view{
      .depth_m = depth_m[0], .camera = pinhole_camera(intrinsics), .stride_px = kPixelStride};
  view.half_steps = static_cast<int>(std::ceil(half_blocks - 1e-3));
  view.step_m = volume.truncation_m() / static_cast<float>(view.half_steps);
  for (int axis = 0; axis < 3; ++axis) {
    view.origin_blocks[axis] = static_cast<float>(origin_blocks[axis]);
    for (int axis_C = 0; axis_C < 3; ++axis_C) {
      view.blocks_per_m[axis][axis_C] = static_cast<float>(X_WC.linear()(axis, axis_C) / block_m);
    }
  }
  return view;
}

int most_blocks_in_a_row(const AllocationView& view) {
  const int num_pixels = (view.camera.width + view.stride_px - 1) / view.stride_px;
  return num_pixels * (2 * view.half_steps + 1);
}

/// Ascending, each once.
PackedBlocks find_missing_blocks(const VolumeView& volume, const AllocationView& view,
                                 const Kernels& kernels) {
  tbb::enumerable_thread_specific<PackedBlocks> found;
  const int num_rows = (view.camera.height + kPixelStride - 1) / kPixelStride;
  tbb::parallel_for(tbb::blocked_range<int>(0, num_rows, 16), [&](const auto& rows) {
    PackedBlocks& blocks = found.local();
    for (int row = rows.begin(); row < rows.end(); ++row) {
      const std::size_t before = blocks.size();
      blocks.resize(before + most_blocks_in_a_row(view));
      const int count =
          kernels.find_missing_blocks(volume, view, row * kPixelStride, &blocks[before]);
      blocks.resize(before + count);
    }
  });
  PackedBlocks all;
  for (const PackedBlocks& part : found) all.insert(all.end(), part.begin(), part.end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

BlockCoord unpack(std::uint32_t block, const BlockCoord& min) {
  const auto coordinate = [block](int axis) {
    constexpr std::uint32_t kMask = (1U << VolumeView::kSideBits) - 1;
    return static_cast<int>((block >> (axis * VolumeView::kSideBits)) & kMask);
  };
  return make_block_coord(min.x + coordinate(0), min.y + coordinate(1), min.z + coordinate(2));
}

}  // namespace

void allocate_seen_blocks(const cv::Mat_<float>& depth_m, const Intrinsics& intrinsics,
                          const Pose& X_WC, float min_depth_m, float max_depth_m,
                          const Kernels& kernels, TsdfVolume& volume) {
  assert(depth_m.isContinuous());
  AllocationView view = make_allocation_view(depth_m, intrinsics, X_WC, volume);
  view.min_depth_m = min_depth_m;
  view.max_depth_m = max_depth_m;
  for (const std::uint32_t block : find_missing_blocks(view_of(volume), view, kernels)) {
    volume.allocate(unpack(block, volume.min_block()));
  }
}

}  // namespace kintsugi::mapper
