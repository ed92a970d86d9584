#include "mapper/core/block_surface.hpp"

#include <algorithm>
#include <cstdlib>
#include <optional>

namespace kintsugi::mapper {
namespace {

/// The mean of the crossings that lie in a voxel, from its centre in voxels.
std::optional<Eigen::Vector3f> mean_crossing(const PaddedBlock& block, int index,
                                             int weight_threshold) {
  const Voxel voxel = block[index];
  if (voxel_weight(voxel) <= weight_threshold) return std::nullopt;
  const int distance = voxel_distance_raw(voxel);
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  int count = 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {-1, 1}) {
      const Voxel other = block[index + side * PaddedBlock::kStride[axis]];
      if (voxel_weight(other) <= weight_threshold) continue;
      const int other_distance = voxel_distance_raw(other);
      if ((distance < 0) == (other_distance < 0)) continue;
      // In this voxel where it is nearer to its centre; half way, in the lower of the two.
      const int own = std::abs(distance);
      const int others = std::abs(other_distance);
      if (side > 0 ? own > others : own >= others) continue;
      sum[axis] += static_cast<float>(side * own) / static_cast<float>(own + others);
      ++count;
    }
  }
  if (count == 0) return std::nullopt;
  return sum / static_cast<float>(count);
}

/// Gradient at a voxel's centre: central differences, one-sided where a neighbour was never
/// observed, zero along an axis where neither was.
Eigen::Vector3f gradient_at(const PaddedBlock& block, int index) {
  Eigen::Vector3f gradient = Eigen::Vector3f::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const int stride = PaddedBlock::kStride[axis];
    const bool has_before = voxel_weight(block[index - stride]) > 0;
    const bool has_after = voxel_weight(block[index + stride]) > 0;
    if (!has_before && !has_after) continue;
    const int before = voxel_distance_raw(block[has_before ? index - stride : index]);
    const int after = voxel_distance_raw(block[has_after ? index + stride : index]);
    gradient[axis] = static_cast<float>(after - before) * (has_before && has_after ? 0.5F : 1.0F);
  }
  return gradient;
}

/// Gradient at a point in a voxel, `offset_vox` from its centre: trilinear between the voxels
/// around it that were observed.
Eigen::Vector3f gradient_near(const PaddedBlock& block, int index,
                              const Eigen::Vector3f& offset_vox) {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (int corner = 0; corner < 8; ++corner) {
    int neighbor = index;
    float share = 1.0F;
    for (int axis = 0; axis < 3; ++axis) {
      const float offset = std::abs(offset_vox[axis]);
      const int stride = PaddedBlock::kStride[axis];
      const bool is_far = ((corner >> axis) & 1) != 0;
      share *= is_far ? offset : 1.0F - offset;
      if (is_far) neighbor += offset_vox[axis] < 0.0F ? -stride : stride;
    }
    if (share == 0.0F || voxel_weight(block[neighbor]) == 0) continue;
    sum += share * gradient_at(block, neighbor);
  }
  return sum;
}

}  // namespace

BlockSurface::BlockSurface(const PaddedBlock& block, int weight_threshold) {
  cells_.fill(-1);
  for (int z = -kReach; z < kBlockSide + kReach; ++z) {
    for (int y = -kReach; y < kBlockSide + kReach; ++y) {
      for (int x = -kReach; x < kBlockSide + kReach; ++x) {
        add_point(block, x, y, z, weight_threshold);
      }
    }
  }
}

void BlockSurface::add_point(const PaddedBlock& block, int x, int y, int z, int weight_threshold) {
  const int index = PaddedBlock::index(x, y, z);
  const std::optional<Eigen::Vector3f> crossing = mean_crossing(block, index, weight_threshold);
  if (!crossing) return;
  const Eigen::Vector3f gradient = gradient_near(block, index, *crossing);
  if (gradient.isZero(0.0F)) return;  // the same on all sides: it faces nowhere
  const Eigen::Vector3f center_vox = Eigen::Vector3f(x, y, z).array() + 0.5F;
  cells_[cell_index(x, y, z)] = static_cast<std::int16_t>(points_.size());
  points_.push_back({.voxel = {static_cast<std::int8_t>(x), static_cast<std::int8_t>(y),
                               static_cast<std::int8_t>(z)},
                     .position_vox = center_vox + *crossing,
                     .normal_W = gradient.normalized()});
}

bool BlockSurface::is_in_block(const Point& point) {
  return std::all_of(point.voxel.begin(), point.voxel.end(),
                     [](int c) { return c >= 0 && c < kBlockSide; });
}

Eigen::Vector3f BlockSurface::mean_normal(const Point& point, float radius_vox) const {
  const auto [x, y, z] = point.voxel;
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (int dz = -kReach; dz <= kReach; ++dz) {
    for (int dy = -kReach; dy <= kReach; ++dy) {
      for (int dx = -kReach; dx <= kReach; ++dx) {
        const int cell = cells_[cell_index(x + dx, y + dy, z + dz)];
        if (cell < 0) continue;
        const Point& other = points_[cell];
        if ((other.position_vox - point.position_vox).squaredNorm() > radius_vox * radius_vox)
          continue;
        if (other.normal_W.dot(point.normal_W) > 0.0F) sum += other.normal_W;
      }
    }
  }
  return sum.normalized();
}

}  // namespace kintsugi::mapper
