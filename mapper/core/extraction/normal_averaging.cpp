#include "mapper/core/extraction/normal_averaging.hpp"

namespace kintsugi::mapper {

void PaddedPoints::assign(const std::array<const BlockPoints*, 27>& around) {
  points_.clear();
  const auto offset_of = [](int voxel) { return voxel < 0 ? -1 : (voxel < kBlockSide ? 0 : 1); };
  constexpr unsigned kLastOfBefore = 0xFFU << (kBlockSide - kReach) & 0xFFU;
  constexpr std::array<unsigned, 3> kVoxels = {kLastOfBefore, 0xFFU, (1U << kReach) - 1U};
  for (int z = -kReach; z < kBlockSide + kReach; ++z) {
    const int dz = offset_of(z);
    for (int y = -kReach; y < kBlockSide + kReach; ++y) {
      const int dy = offset_of(y);
      Row& row = rows_[(z + kReach) * kSide + y + kReach];
      row = {.mask = 0, .start = static_cast<int>(points_.size())};
      const int block_row = (z - dz * kBlockSide) * kBlockSide + y - dy * kBlockSide;
      for (int dx = -1; dx <= 1; ++dx) {
        const BlockPoints* block = around[neighbor_index(dx, dy, dz)];
        if (block == nullptr) continue;
        const BlockPoints::Point* from = block->row_points(block_row);
        for (unsigned left = block->row_mask(block_row); left != 0; left &= left - 1, ++from) {
          const int voxel = std::countr_zero(left);
          if ((kVoxels[dx + 1] >> voxel & 1U) == 0) continue;
          const int x = voxel + dx * kBlockSide;
          row.mask |= 1U << (x + kReach);
          const Eigen::Vector3f center_vox = Eigen::Vector3f(x, y, z).array() + 0.5F;
          const Eigen::Vector3f p_vox = center_vox + from->offset_vox;
          const Eigen::Vector3f& n = from->normal_W;
          points_.push_back({{p_vox.x(), p_vox.y(), p_vox.z(), 0.0F}, {n.x(), n.y(), n.z(), 0.0F}});
        }
      }
    }
  }
}

Eigen::Vector3f PaddedPoints::mean_normal(const Point& point, int x, int y, int z,
                                          float radius_vox) const {
  const float squared_radius = radius_vox * radius_vox;
  const auto& p = point.position_vox;
  const auto& n = point.normal_W;
  std::array<float, 4> sum{};
  for (int dz = -kReach; dz <= kReach; ++dz) {
    for (int dy = -kReach; dy <= kReach; ++dy) {
      const Row& near = row(y + dy, z + dz);
      if ((near.mask >> x & 0x1FU) == 0) continue;  // voxels x - 2 .. x + 2
      const Point* const end = points_of(near, x + kReach + 1);
      for (const Point* other = points_of(near, x - kReach); other != end; ++other) {
        const auto& q = other->position_vox;
        const auto& m = other->normal_W;
        const float dx_vox = q[0] - p[0];
        const float dy_vox = q[1] - p[1];
        const float dz_vox = q[2] - p[2];
        const float squared = dx_vox * dx_vox + (dy_vox * dy_vox + dz_vox * dz_vox);
        const float cosine = m[0] * n[0] + (m[1] * n[1] + m[2] * n[2]);
        const bool counts = !(squared > squared_radius) && cosine > 0.0F;
        for (int i = 0; i < 4; ++i) sum[i] += counts ? m[i] : 0.0F;
      }
    }
  }
  return Eigen::Vector3f(sum[0], sum[1], sum[2]).normalized();
}

}  // namespace kintsugi::mapper
