#include "tests/mapper/core/simd/tsdf_sampler.hpp"

namespace kintsugi::mapper::testing {
namespace {

constexpr int kLocalMask = kBlockSide - 1;

int local_index(int x, int y, int z) {
  return voxel_index(x & kLocalMask, y & kLocalMask, z & kLocalMask);
}

/// std::floor is a call into the library without SSE4.1.
int floor_int(float value) {
  const int truncated = static_cast<int>(value);
  return truncated - static_cast<int>(static_cast<float>(truncated) > value);
}

/// The eight voxels around a point: the first of them, and how far the point is from its centre.
struct Cell {
  explicit Cell(const Eigen::Vector3f& point_vox) {
    for (int axis = 0; axis < 3; ++axis) {
      const float from_center = point_vox[axis] - 0.5F;
      corner[axis] = floor_int(from_center);
      fraction[axis] = from_center - static_cast<float>(corner[axis]);
    }
  }
  bool is_in_one_block() const {
    return (corner[0] & kLocalMask) != kLocalMask && (corner[1] & kLocalMask) != kLocalMask &&
           (corner[2] & kLocalMask) != kLocalMask;
  }

  int corner[3];
  float fraction[3];
};

float mix(float a, float b, float fraction) { return a + fraction * (b - a); }

float interpolate(const Voxel voxels[8], const float fraction[3]) {
  const auto along_x = [&](int first) {
    return mix(static_cast<float>(voxel_distance_raw(voxels[first])),
               static_cast<float>(voxel_distance_raw(voxels[first + 1])), fraction[0]);
  };
  const float near = mix(along_x(0), along_x(2), fraction[1]);
  const float far = mix(along_x(4), along_x(6), fraction[1]);
  return mix(near, far, fraction[2]) * (1.0F / kDistanceScale);
}

}  // namespace

BlockSlot TsdfSampler::slot_of(int x, int y, int z) {
  const BlockCoord block = make_block_coord(x >> 3, y >> 3, z >> 3);
  if (block != last_block_) {
    const BlockCoord& origin = volume_.min_block();
    last_block_ = block;
    last_slot_ =
        volume_.find(make_block_coord(block.x + origin.x, block.y + origin.y, block.z + origin.z));
  }
  return last_slot_;
}

std::optional<Voxel> TsdfSampler::nearest(const Eigen::Vector3f& point_vox) {
  const int x = floor_int(point_vox.x());
  const int y = floor_int(point_vox.y());
  const int z = floor_int(point_vox.z());
  const BlockSlot slot = slot_of(x, y, z);
  if (slot == kNoBlock) return std::nullopt;
  return volume_.voxels(slot).voxels[local_index(x, y, z)];
}

std::optional<float> TsdfSampler::distance(const Eigen::Vector3f& point_vox) {
  const Cell cell(point_vox);
  const auto [x, y, z] = cell.corner;
  Voxel voxels[8];
  if (cell.is_in_one_block()) {
    const BlockSlot slot = slot_of(x, y, z);
    if (slot == kNoBlock) return std::nullopt;
    const Voxel* first = &volume_.voxels(slot).voxels[local_index(x, y, z)];
    for (int i = 0; i < 8; ++i) voxels[i] = first[voxel_index(i & 1, (i >> 1) & 1, i >> 2)];
  } else {
    for (int i = 0; i < 8; ++i) {
      const int vx = x + (i & 1);
      const int vy = y + ((i >> 1) & 1);
      const int vz = z + (i >> 2);
      const BlockSlot slot = slot_of(vx, vy, vz);
      if (slot == kNoBlock) return std::nullopt;
      voxels[i] = volume_.voxels(slot).voxels[local_index(vx, vy, vz)];
    }
  }
  for (const Voxel voxel : voxels) {
    if (voxel_weight(voxel) == 0) return std::nullopt;
  }
  return interpolate(voxels, cell.fraction);
}

}  // namespace kintsugi::mapper::testing
