#include "mapper/core/fusion/block_allocation.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <vector>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/parallel_for.h>

namespace kintsugi::mapper {
namespace {

/// Cube coordinates of blocks, packed as FindMissingBlocks says.
using PackedBlocks = std::vector<std::uint32_t>;

/// At the usual size of voxels a block covers several pixels up to the longest range, so that every
/// second one suffices to find all blocks.
constexpr int kPixelStride = 2;

/// Rays are sampled in steps of half a block along z, and of less than a block along themselves.
AllocationArguments make_arguments(const cv::Mat_<float>& depth_m, const PinholeCamera& camera,
                                   const Pose& X_WC, const TsdfVolume& volume) {
  const double block_m = volume.config().resolution_m * kBlockSide;
  const BlockCoord& min = volume.min_block();
  const Eigen::Vector3d origin_blocks =
      X_WC.translation() / block_m - Eigen::Vector3d(min.x, min.y, min.z);
  const double half_blocks = volume.truncation_m() / block_m * 2.0;
  AllocationArguments arguments{.depth_m = depth_m[0], .camera = camera, .stride_px = kPixelStride};
  arguments.half_steps = static_cast<int>(std::ceil(half_blocks - 1e-3));
  arguments.step_m = volume.truncation_m() / static_cast<float>(arguments.half_steps);
  for (int axis = 0; axis < 3; ++axis) {
    arguments.origin_blocks[axis] = static_cast<float>(origin_blocks[axis]);
    for (int axis_C = 0; axis_C < 3; ++axis_C) {
      arguments.blocks_per_m[axis][axis_C] =
          static_cast<float>(X_WC.linear()(axis, axis_C) / block_m);
    }
  }
  return arguments;
}

int most_blocks_in_a_row(const AllocationArguments& arguments) {
  const int num_pixels = (arguments.camera.width + arguments.stride_px - 1) / arguments.stride_px;
  return num_pixels * (2 * arguments.half_steps + 1);
}

/// The missing blocks, ascending, without duplicates.
PackedBlocks find_missing_blocks(const VolumeAccess& volume, const AllocationArguments& arguments,
                                 const Kernels& kernels) {
  tbb::enumerable_thread_specific<PackedBlocks> found;
  const int num_rows = (arguments.camera.height + kPixelStride - 1) / kPixelStride;
  tbb::parallel_for(tbb::blocked_range<int>(0, num_rows, 16), [&](const auto& rows) {
    PackedBlocks& blocks = found.local();
    for (int row = rows.begin(); row < rows.end(); ++row) {
      const std::size_t before = blocks.size();
      blocks.resize(before + most_blocks_in_a_row(arguments));
      const int count =
          kernels.find_missing_blocks(volume, arguments, row * kPixelStride, &blocks[before]);
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
    constexpr std::uint32_t kMask = (1U << VolumeAccess::kSideBits) - 1;
    return static_cast<int>((block >> (axis * VolumeAccess::kSideBits)) & kMask);
  };
  return make_block_coord(min.x + coordinate(0), min.y + coordinate(1), min.z + coordinate(2));
}

}  // namespace

void allocate_seen_blocks(const cv::Mat_<float>& depth_m, const PinholeCamera& camera,
                          const Pose& X_WC, float min_depth_m, float max_depth_m,
                          const Kernels& kernels, TsdfVolume& volume) {
  assert(depth_m.isContinuous());
  AllocationArguments arguments = make_arguments(depth_m, camera, X_WC, volume);
  arguments.min_depth_m = min_depth_m;
  arguments.max_depth_m = max_depth_m;
  for (const std::uint32_t block :
       find_missing_blocks(volume.kernel_access(), arguments, kernels)) {
    const BlockCoord coord = unpack(block, volume.min_block());
    if (volume.contains(coord)) volume.allocate(coord);
  }
}

}  // namespace kintsugi::mapper
