#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "mapper/synthetic/scene/scene.hpp"

namespace kintsugi::segmenter::bench {

inline constexpr double kVoxel_m = 0.01;
inline constexpr int kBlockVoxels = 8;
inline constexpr double kBlock_m = kBlockVoxels * kVoxel_m;

/// A cube of voxels of the grid, frame W.
struct Block {
  int x = 0;
  int y = 0;
  int z = 0;
};

/// The signed distance to a scene with the noise of a depth camera, and its zero surface. All
/// methods are thread-safe.
class NoisyField {
 public:
  /// `scene` must outlive the field.
  NoisyField(const synthetic::Scene& scene, double noise, std::uint32_t seed);

  /// The surface in a block at the `visit`-th visit (from 0): each visit has its own noise, and
  /// each after the first a drift. Patches of about 25 cm are missing.
  [[nodiscard]] std::vector<CloudPoint> surface_W(const Block& block, int visit) const;

 private:
  /// A solid and the transformation from W to its own frame.
  struct Solid {
    synthetic::Shape shape;
    Pose X_OW;
  };
  class Samples;

  [[nodiscard]] std::vector<const Solid*> solids_near(const Eigen::Vector3d& centre_W) const;
  [[nodiscard]] double distance_noise_m(const Eigen::Vector3d& p_W, const Eigen::Vector3i& voxel,
                                        std::uint32_t seed) const;
  [[nodiscard]] Samples sample(const Block& block, const std::vector<const Solid*>& solids,
                               int visit) const;

  double noise_;
  std::uint32_t seed_;
  std::vector<Solid> solids_;
  /// For each coarse cell, the solids whose surface may be near it.
  std::map<std::array<int, 3>, std::vector<std::uint32_t>> solids_in_cell_;
};

}  // namespace kintsugi::segmenter::bench
