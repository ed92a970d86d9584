#include "mapper/core/reactivation/covered_surface.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <deque>
#include <functional>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include <tbb/parallel_for.h>

#include "mapper/core/reactivation/covered_voxels.hpp"

namespace kintsugi::mapper {
namespace {

/// The voxels of a block; null where there is none.
using FindBlock = std::function<const VoxelBlock*(const BlockCoord&)>;

/// Where the voxel's surface is, by its distance and the gradient of the distance.
struct NearSurface {
  Eigen::Vector3d offset_vox;  ///< from the voxel's centre
  Eigen::Vector3d normal;      ///< unit
};

/// Distances in voxels, of blocks that are found by their coordinates.
template <typename Find>
class DistanceField {
 public:
  DistanceField(Find find_block, double truncation_vox, int weight_threshold)
      : find_block_(std::move(find_block)),
        scale_(truncation_vox),
        weight_threshold_(weight_threshold) {}

  /// More often than the threshold.
  bool is_observed(const Eigen::Vector3i& voxel) {
    return distance_vox(voxel, weight_threshold_).has_value();
  }

  /// The surface near an observed voxel; nothing where none is within `max_distance_vox`.
  std::optional<NearSurface> surface_near(const Eigen::Vector3i& voxel, double max_distance_vox) {
    const auto here = distance_vox(voxel, weight_threshold_);
    if (!here || std::abs(*here) > max_distance_vox) return std::nullopt;
    // Around it any observation will do: surface ends where there are few.
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3i step = Eigen::Vector3i::Unit(axis);
      const auto after = distance_vox(voxel + step, 0);
      const auto before = distance_vox(voxel - step, 0);
      if (!after && !before) continue;
      gradient[axis] =
          after && before ? 0.5 * (*after - *before) : (after ? *after - *here : *here - *before);
    }
    const double slope = gradient.norm();
    if (!(slope > kLeastSlope)) return std::nullopt;
    // The distance is measured along the ray, which may meet the surface at an angle.
    return NearSurface{-*here / (slope * slope) * gradient, gradient / slope};
  }

 private:
  static constexpr double kLeastSlope = 0.1;  // below it distances are truncated, or noise

  /// Of voxel (x, y, z), counted from the origin; nothing where it was not observed more often than
  /// `threshold`.
  std::optional<double> distance_vox(const Eigen::Vector3i& voxel, int threshold) {
    static_assert(kBlockSide == 8);
    const BlockCoord coord = make_block_coord(voxel.x() >> 3, voxel.y() >> 3, voxel.z() >> 3);
    if (coord != last_coord_ || !has_last_) {  // most are in the same one
      last_ = find_block_(coord);
      last_coord_ = coord;
      has_last_ = true;
    }
    if (last_ == nullptr) return std::nullopt;
    const Voxel value = last_->voxels[voxel_index(voxel.x() & 7, voxel.y() & 7, voxel.z() & 7)];
    if (voxel_weight(value) <= threshold) return std::nullopt;
    return scale_ * static_cast<double>(voxel_distance(value));
  }

  Find find_block_;
  double scale_;
  int weight_threshold_;
  BlockCoord last_coord_;
  const VoxelBlock* last_ = nullptr;
  bool has_last_ = false;
};

/// Where the distances of a block change their sign. Most blocks have few such places, or none, and
/// are done with then.
class Signs {
 public:
  Signs(const FindBlock& find, const BlockCoord& coord) {
    for (int dz = -1; dz <= 1; ++dz) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          if (std::abs(dx) + std::abs(dy) + std::abs(dz) > 1) continue;  // shares no face
          const VoxelBlock* const block =
              find(make_block_coord(coord.x + dx, coord.y + dy, coord.z + dz));
          if (block != nullptr) copy(*block, {dx, dy, dz});
        }
      }
    }
  }

  /// From this voxel of the block to one that shares a face with it.
  bool change_at(int x, int y, int z) const {
    const auto* const here = &signs_[place(x, y, z)];
    if (*here == 0) return false;
    for (const int step : {1, kSide, kSide * kSide}) {
      if (here[step] == -*here || here[-step] == -*here) return true;
    }
    return false;
  }

 private:
  static constexpr int kSide = kBlockSide + 2;
  static int place(int x, int y, int z) { return ((z + 1) * kSide + y + 1) * kSide + x + 1; }

  /// Of a block beside this one, the voxels that share a face with it.
  void copy(const VoxelBlock& block, const std::array<int, 3>& beside) {
    std::array<int, 3> first{};
    std::array<int, 3> end{};
    for (int axis = 0; axis < 3; ++axis) {
      first[axis] = beside[axis] < 0 ? kBlockSide - 1 : 0;
      end[axis] = beside[axis] > 0 ? 1 : kBlockSide;
    }
    for (int z = first[2]; z < end[2]; ++z) {
      for (int y = first[1]; y < end[1]; ++y) {
        for (int x = first[0]; x < end[0]; ++x) {
          const Voxel voxel = block.voxels[voxel_index(x, y, z)];
          if (voxel_weight(voxel) == 0) continue;
          signs_[place(x + kBlockSide * beside[0], y + kBlockSide * beside[1],
                       z + kBlockSide * beside[2])] = voxel_distance_raw(voxel) < 0 ? -1 : 1;
        }
      }
    }
  }

  std::array<std::int8_t, std::size_t{kSide} * kSide * kSide> signs_{};  ///< 0: not observed
};

void clear(VoxelBlock& block, const VoxelSet& covered) {
  for (int index = 0; index < kBlockVoxels; ++index) {
    if (covered[index]) block.voxels[index] = 0;
  }
}

/// Decides about the voxels of a volume.
class Comparison {
 public:
  Comparison(FindBlock find, const TsdfVolume::Config& volume, const SameSurface& same)
      : find_(std::move(find)),
        same_(same),
        voxel_m_(volume.resolution_m),
        truncation_vox_(volume.largest_truncation_vox()),
        reach_vox_(volume.truncation_vox),
        min_cosine_(cosine(same.max_angle_deg)),
        min_cosine_doubtful_(cosine(kDoubtful * same.max_angle_deg)) {}

  /// About all blocks of these groups, in their order.
  std::vector<CoveredVoxels> decide(const std::vector<BlocksUnderCovers>& groups) const {
    std::vector<BlockCoord> blocks;
    std::vector<const std::vector<Cover>*> covers_of;
    for (const auto& [coords, covers] : groups) {
      blocks.insert(blocks.end(), coords.begin(), coords.end());
      covers_of.insert(covers_of.end(), coords.size(), &covers);
    }
    std::vector<CoveredVoxels> decisions(blocks.size());
    tbb::parallel_for(std::size_t{0}, blocks.size(),
                      [&](std::size_t i) { decisions[i] = decide(blocks[i], *covers_of[i]); });
    return closed(blocks, decisions);
  }

 private:
  static constexpr double kDoubtful = 2.0;  ///< times the limits of the same surface

  /// About the voxels between which and the next one there is surface, each by itself. Blocks that
  /// no cover is near have none.
  CoveredVoxels decide(const BlockCoord& coord, const std::vector<Cover>& covers) const {
    CoveredVoxels decision;
    std::vector<Placed> near = covers_near(coord, covers);
    if (near.empty()) return decision;
    const Signs signs(find_, coord);
    DistanceField own(find_, truncation_vox_, 0);
    for (int index = 0; index < kBlockVoxels; ++index) {
      const Eigen::Vector3i in_block(index % kBlockSide, index / kBlockSide % kBlockSide,
                                     index / (kBlockSide * kBlockSide));
      if (!signs.change_at(in_block.x(), in_block.y(), in_block.z())) continue;
      const Eigen::Vector3i voxel =
          kBlockSide * Eigen::Vector3i(coord.x, coord.y, coord.z) + in_block;
      const auto surface = own.surface_near(voxel, reach_vox_);
      decision.surface.set(index);
      auto there = surface ? There::kNotObserved : There::kOther;
      for (std::size_t i = 0; i < near.size() && surface && there != There::kSame; ++i) {
        there = std::max(there, compare(near[i], voxel, *surface));
      }
      decision.covered[index] = there == There::kSame;
      decision.differing[index] = there == There::kOther;
    }
    return decision;
  }

  /// What a cover has in the place of a surface; the best of several is the greatest.
  enum class There {
    kNotObserved,
    kOther,     ///< no surface, or another one
    kDoubtful,  ///< a surface within twice the limits: another one, or the same with noise
    kSame,
  };
  struct FindIn {
    const std::vector<StoredBlock>* blocks;
    const VoxelBlock* operator()(const BlockCoord& coord) const {
      const auto found = std::ranges::lower_bound(*blocks, coord, {}, &StoredBlock::coord);
      return found == blocks->end() || found->coord != coord ? nullptr : &found->voxels;
    }
  };
  struct Placed {
    Pose X_OU;
    double min_cosine;  ///< of the angle between the normals
    DistanceField<FindIn> distances_O;
  };

  static double cosine(double angle_deg) {
    return std::cos(std::min(angle_deg, 180.0) * std::numbers::pi / 180.0);
  }

  std::vector<Placed> covers_near(const BlockCoord& coord, const std::vector<Cover>& covers) const {
    const double block_m = kBlockSide * voxel_m_;
    const Eigen::Vector3d center_U =
        block_m * (Eigen::Vector3d(coord.x, coord.y, coord.z).array() + 0.5).matrix();
    const double radius_m =
        0.5 * std::sqrt(3.0) * block_m + kDoubtful * same_.max_distance_vox * voxel_m_;
    std::vector<Placed> near;
    for (const Cover& cover : covers) {
      const double limit_m = radius_m + cover.radius_m;
      if ((cover.center_U - center_U).squaredNorm() > limit_m * limit_m) continue;
      near.push_back({cover.X_OU,
                      cover.is_in_place ? min_cosine_doubtful_ : min_cosine_,
                      {FindIn{cover.blocks.get()}, truncation_vox_, same_.weight_threshold}});
    }
    return near;
  }

  There compare(Placed& cover, const Eigen::Vector3i& voxel, const NearSurface& surface) const {
    const Eigen::Vector3d p_U =
        voxel_m_ * (voxel.cast<double>().array() + 0.5 + surface.offset_vox.array()).matrix();
    const Eigen::Vector3d p_O = cover.X_OU * p_U;
    const Eigen::Vector3i at = (p_O / voxel_m_).array().floor().cast<int>();
    if (!cover.distances_O.is_observed(at)) return There::kNotObserved;
    const auto found = cover.distances_O.surface_near(at, reach_vox_);
    if (!found) return There::kOther;
    const Eigen::Vector3d center_O = voxel_m_ * (at.cast<double>().array() + 0.5).matrix();
    const double distance_vox =
        std::abs(((p_O - center_O) / voxel_m_ - found->offset_vox).dot(found->normal));
    const double cosine = found->normal.dot(cover.X_OU.linear() * surface.normal);
    if (distance_vox <= same_.max_distance_vox && cosine >= cover.min_cosine) return There::kSame;
    const bool is_doubtful =
        distance_vox <= kDoubtful * same_.max_distance_vox && cosine >= min_cosine_doubtful_;
    return is_doubtful ? There::kDoubtful : There::kOther;
  }

  const FindBlock find_;
  const SameSurface& same_;
  const double voxel_m_;
  const double truncation_vox_;
  const double reach_vox_;  ///< no crossing is farther from a voxel
  const double min_cosine_;
  const double min_cosine_doubtful_;  ///< also of covers in place
};

}  // namespace

void clear_covered(TsdfVolume& volume, const std::vector<BlocksUnderCovers>& groups,
                   const SameSurface& same) {
  // All are looked at before any is changed: the gradients need the blocks around as they are.
  const Comparison comparison(
      [&](const BlockCoord& coord) {
        const BlockSlot slot = volume.find(coord);
        return slot == kNoBlock ? nullptr : &std::as_const(volume).voxels(slot);
      },
      volume.config(), same);
  const std::vector<CoveredVoxels> decisions = comparison.decide(groups);
  auto decision = decisions.begin();
  for (const BlocksUnderCovers& group : groups) {
    for (const BlockCoord& coord : group.coords) {
      const CoveredVoxels& voxels = *decision++;
      if (voxels.covered.none()) continue;
      const BlockSlot slot = volume.find(coord);
      if (voxels.has_rest()) {
        clear(volume.voxels(slot), voxels.covered);
      } else {
        volume.discard(slot);
      }
    }
  }
}

DetachedBlocks without_covered(DetachedBlocks blocks, const TsdfVolume::Config& volume,
                               const std::vector<BlocksUnderCovers>& groups,
                               const SameSurface& same) {
  const auto number_of = [&](const BlockCoord& coord) -> std::optional<std::size_t> {
    const auto found = std::ranges::lower_bound(blocks.coords, coord);
    if (found == blocks.coords.end() || *found != coord) return std::nullopt;
    return found - blocks.coords.begin();
  };
  const Comparison comparison(
      [&](const BlockCoord& coord) -> const VoxelBlock* {
        const auto number = number_of(coord);
        return number ? blocks.voxels[*number] : nullptr;
      },
      volume, same);
  const std::vector<CoveredVoxels> in_groups = comparison.decide(groups);
  std::vector<CoveredVoxels> decisions(blocks.coords.size());
  auto next = in_groups.begin();
  for (const BlocksUnderCovers& group : groups) {
    for (const BlockCoord& coord : group.coords) decisions[number_of(coord).value()] = *next++;
  }
  struct Storage {
    std::shared_ptr<const void> before;
    std::deque<VoxelBlock> cleared;
  };
  const auto storage = std::make_shared<Storage>(Storage{std::move(blocks.storage), {}});
  std::size_t num_left = 0;
  for (std::size_t i = 0; i < decisions.size(); ++i) {
    const VoxelSet& covered = decisions[i].covered;
    if (covered.any() && !decisions[i].has_rest()) continue;
    const VoxelBlock* voxels = blocks.voxels[i];
    if (covered.any()) {
      clear(storage->cleared.emplace_back(*voxels), covered);
      voxels = &storage->cleared.back();
    }
    blocks.coords[num_left] = blocks.coords[i];
    blocks.voxels[num_left] = voxels;
    blocks.colors[num_left] = blocks.colors[i];
    ++num_left;
  }
  blocks.coords.resize(num_left);
  blocks.voxels.resize(num_left);
  blocks.colors.resize(num_left);
  blocks.storage = storage;
  return blocks;
}

}  // namespace kintsugi::mapper
