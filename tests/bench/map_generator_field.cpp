#include "tests/bench/map_generator_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mapper/synthetic/scene/counter_random.hpp"

namespace kintsugi::segmenter::bench {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr double kCell_m = 0.5;
// Largest distance from the centre of a block to a voxel that its gradients need, plus the noise.
constexpr double kReach_m = 0.12;
// Walls are at round coordinates; the offset keeps grid points off them.
const Vector3d kGridOrigin_W(0.0037, 0.0041, 0.0043);

// Noise that a depth camera leaves in a fused map: correlation lengths and amplitudes, metres.
constexpr double kFineLength_m = 0.03;
constexpr double kFineNoise_m = 0.0006;
constexpr double kCoarseLength_m = 0.12;
constexpr double kCoarseNoise_m = 0.002;
constexpr double kVoxelNoise_m = 0.00012;
constexpr double kDriftLength_m = 3.0;
constexpr double kDrift_m = 0.003;
constexpr double kPatchLength_m = 0.25;
constexpr double kUnseenAbove = 0.55;  // threshold for noise in [-1, 1]

/// White noise in [-1, 1): independent for any two grid points.
double noise_at(int x, int y, int z, std::uint32_t seed) {
  using synthetic::hash32;
  const auto mixed =
      hash32(hash32(hash32(seed, static_cast<std::uint32_t>(x)), static_cast<std::uint32_t>(y)),
             static_cast<std::uint32_t>(z));
  return 2.0 * synthetic::unit_float(mixed) - 1.0;
}

/// Smooth noise: noise_at() on a grid of `length_m`, interpolated.
double smooth_noise(const Vector3d& p_W, double length_m, std::uint32_t seed) {
  const Vector3d scaled = p_W / length_m;
  const Vector3d corner = scaled.array().floor();
  const Vector3d f = scaled - corner;
  const Vector3d s = f.array().square() * (3.0 - 2.0 * f.array());
  const Vector3i c = corner.cast<int>();
  double sum = 0.0;
  for (int k = 0; k < 8; ++k) {
    const int dx = k & 1;
    const int dy = (k >> 1) & 1;
    const int dz = k >> 2;
    const double share = (dx != 0 ? s.x() : 1.0 - s.x()) * (dy != 0 ? s.y() : 1.0 - s.y()) *
                         (dz != 0 ? s.z() : 1.0 - s.z());
    sum += share * noise_at(c.x() + dx, c.y() + dy, c.z() + dz, seed);
  }
  return sum;
}

Vector3d grid_point_W(const Vector3i& voxel) {
  return kGridOrigin_W + kVoxel_m * voxel.cast<double>();
}

}  // namespace

/// The field at the voxels of a block, and at one voxel before and two after it in each direction.
class NoisyField::Samples {
 public:
  static constexpr int kSide = kBlockVoxels + 3;

  explicit Samples(const Block& block)
      : first_(Vector3i(block.x, block.y, block.z) * kBlockVoxels - Vector3i::Ones()) {}

  [[nodiscard]] Vector3i voxel(const Vector3i& at) const { return first_ + at; }
  float& operator()(const Vector3i& at) { return values_[index(at)]; }
  float operator()(const Vector3i& at) const { return values_[index(at)]; }
  [[nodiscard]] Vector3d gradient(const Vector3i& at) const {
    Vector3d g;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3i step = Vector3i::Unit(axis);
      g[axis] = (*this)(at + step) - (*this)(at - step);
    }
    return g;
  }

 private:
  static std::size_t index(const Vector3i& at) {
    const Eigen::Matrix<std::size_t, 3, 1> p = at.cast<std::size_t>();
    return (p.x() * kSide + p.y()) * kSide + p.z();
  }

  Vector3i first_;
  std::array<float, std::size_t{kSide} * kSide * kSide> values_{};
};

NoisyField::NoisyField(const synthetic::Scene& scene, double noise, std::uint32_t seed)
    : noise_(noise), seed_(seed) {
  for (const synthetic::Primitive& primitive : scene.primitives()) {
    const auto index = static_cast<std::uint32_t>(solids_.size());
    solids_.push_back({primitive.shape, primitive.X_WO.inverse()});
    const Vector3d half_W = primitive.X_WO.linear().cwiseAbs() * primitive.shape.half_extents +
                            Vector3d::Constant(kReach_m);
    const Vector3d centre_W = primitive.X_WO.translation();
    const Vector3i low = ((centre_W - half_W) / kCell_m).array().floor().cast<int>();
    const Vector3i high = ((centre_W + half_W) / kCell_m).array().floor().cast<int>();
    for (int x = low.x(); x <= high.x(); ++x) {
      for (int y = low.y(); y <= high.y(); ++y) {
        for (int z = low.z(); z <= high.z(); ++z) solids_in_cell_[{x, y, z}].push_back(index);
      }
    }
  }
}

/// The solids that determine the field around a block; none if no surface is near.
std::vector<const NoisyField::Solid*> NoisyField::solids_near(const Vector3d& centre_W) const {
  const Vector3i cell = (centre_W / kCell_m).array().floor().cast<int>();
  const auto found = solids_in_cell_.find({cell.x(), cell.y(), cell.z()});
  if (found == solids_in_cell_.end()) return {};
  std::vector<const Solid*> near;
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const std::uint32_t index : found->second) {
    const Solid& solid = solids_[index];
    const double distance_m = synthetic::signed_distance(solid.shape, solid.X_OW * centre_W);
    if (distance_m < kReach_m) near.push_back(&solid);
    nearest_m = std::min(nearest_m, distance_m);
  }
  if (std::abs(nearest_m) > kReach_m) near.clear();
  return near;
}

double NoisyField::distance_noise_m(const Vector3d& p_W, const Vector3i& voxel,
                                    std::uint32_t seed) const {
  return noise_ * (kFineNoise_m * smooth_noise(p_W, kFineLength_m, seed + 1) +
                   kCoarseNoise_m * smooth_noise(p_W, kCoarseLength_m, seed + 2) +
                   kVoxelNoise_m * noise_at(voxel.x(), voxel.y(), voxel.z(), seed + 3));
}

NoisyField::Samples NoisyField::sample(const Block& block, const std::vector<const Solid*>& solids,
                                       int visit) const {
  const std::uint32_t seed = synthetic::hash32(seed_, static_cast<std::uint32_t>(visit));
  Samples samples(block);
  Vector3d drift_W = Vector3d::Zero();
  if (visit > 0) {
    const Vector3d p_W = grid_point_W(samples.voxel(Vector3i::Zero()));
    for (int axis = 0; axis < 3; ++axis) {
      drift_W[axis] = kDrift_m * smooth_noise(p_W, kDriftLength_m,
                                              seed + 10 + static_cast<std::uint32_t>(axis));
    }
  }
  Vector3i at;
  for (at.x() = 0; at.x() < Samples::kSide; ++at.x()) {
    for (at.y() = 0; at.y() < Samples::kSide; ++at.y()) {
      for (at.z() = 0; at.z() < Samples::kSide; ++at.z()) {
        const Vector3i voxel = samples.voxel(at);
        const Vector3d p_W = grid_point_W(voxel);
        double distance_m = std::numeric_limits<double>::infinity();
        for (const Solid* const solid : solids) {
          distance_m = std::min(
              distance_m, synthetic::signed_distance(solid->shape, solid->X_OW * (p_W + drift_W)));
        }
        samples(at) = static_cast<float>(distance_m + distance_noise_m(p_W, voxel, seed));
      }
    }
  }
  return samples;
}

std::vector<CloudPoint> NoisyField::surface_W(const Block& block, int visit) const {
  const Vector3d centre_W =
      kBlock_m * (Vector3d(block.x, block.y, block.z) + Vector3d::Constant(0.5));
  const auto solids = solids_near(centre_W);
  if (solids.empty()) return {};
  const Samples samples = sample(block, solids, visit);
  const std::uint32_t patch_seed = synthetic::hash32(seed_ + 5, static_cast<std::uint32_t>(visit));
  std::vector<CloudPoint> points_W;
  Vector3i at;
  for (at.x() = 1; at.x() <= kBlockVoxels; ++at.x()) {
    for (at.y() = 1; at.y() <= kBlockVoxels; ++at.y()) {
      for (at.z() = 1; at.z() <= kBlockVoxels; ++at.z()) {
        const double here = samples(at);
        for (int axis = 0; axis < 3; ++axis) {
          const Vector3i next = at + Vector3i::Unit(axis);
          const double there = samples(next);
          if ((here < 0.0) == (there < 0.0)) continue;
          const double t = here / (here - there);
          const Vector3d gradient = (1.0 - t) * samples.gradient(at) + t * samples.gradient(next);
          if (gradient.norm() < 1e-6) continue;
          const Eigen::Vector3f n = gradient.normalized().cast<float>();
          const Vector3d p = grid_point_W(samples.voxel(at)) + t * kVoxel_m * Vector3d::Unit(axis);
          if (smooth_noise(p, kPatchLength_m, patch_seed) > kUnseenAbove) continue;
          points_W.push_back({.x = static_cast<float>(p.x()),
                              .y = static_cast<float>(p.y()),
                              .z = static_cast<float>(p.z()),
                              .nx = n.x(),
                              .ny = n.y(),
                              .nz = n.z(),
                              .weight = 1.0F});
        }
      }
    }
  }
  return points_W;
}

}  // namespace kintsugi::segmenter::bench
