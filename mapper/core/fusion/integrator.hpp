#pragma once

#include <optional>
#include <vector>

#include "lcmtypes/geometry.hpp"
#include "mapper/core/frame/depth_noise.hpp"
#include "mapper/core/frame/rgbd_frame.hpp"
#include "mapper/core/kernels/instruction_set.hpp"
#include "mapper/core/volume/tsdf_volume.hpp"

namespace kintsugi::mapper {

/// Fuses depth and colour images into the volume: for each voxel in view, a weighted running mean
/// of the truncated signed distance along the camera's z (Curless and Levoy 1996; Newcombe et al.
/// 2011, equations 6 to 13).
class Integrator {
 public:
  struct Config {
    double min_depth_m = 0.3;                            ///< nearer measurements are ignored
    double max_depth_m = 5.0;                            ///< farther measurements are ignored
    std::optional<InstructionSet> instruction_set = {};  ///< none: best_instruction_set()

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };

  explicit Integrator(const Config& config);

  /// Allocates the blocks of the volume that rays meet within its smallest truncation distance of
  /// their measured depth, then updates every block in view. Pixels whose depth is NaN, infinite or
  /// outside [min_depth_m, max_depth_m] change nothing. The truncation distance grows with the
  /// depth's noise, see truncation_by_depth(). Of a ball, blocks
  /// that turn out to be free space are discarded. Colour is fused within the truncation distance;
  /// a frame without colour leaves colours as they are. The result does not depend on the number of
  /// threads.
  /// @throws std::invalid_argument where images and intrinsics disagree in size, the focal length
  /// is not positive, there is lens distortion or X_WC is not finite; the volume is unchanged then
  void integrate(const RgbdFrame& frame, const Pose& X_WC, TsdfVolume& volume,
                 const DepthNoise& noise = {}) const;

 private:
  Config config_;
  InstructionSet instruction_set_;
};

}  // namespace kintsugi::mapper
