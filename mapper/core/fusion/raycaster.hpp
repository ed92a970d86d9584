#pragma once

#include <optional>

#include <opencv2/core.hpp>

#include "lcmtypes/geometry.hpp"
#include "mapper/core/frame/surface_map.hpp"
#include "mapper/core/kernels/instruction_set.hpp"

namespace kintsugi::mapper {

class TsdfVolume;

/// Renders the surface of the volume as a camera would see it.
class Raycaster {
 public:
  struct Config {
    double min_depth_m = 0.3;                            ///< rays start here at the earliest
    double max_depth_m = 6.0;                            ///< and end here
    std::optional<InstructionSet> instruction_set = {};  ///< none: best_instruction_set()

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };

  explicit Raycaster(const Config& config);

  /// Finds the first crossing from free space into a surface along each pixel's ray, at the
  /// resolution of `intrinsics` (no distortion); a pixel without a crossing is NaN. Normals are
  /// those of surface_from_depth(): as accurate as the gradient of the distance, at a tenth of its
  /// cost. The result does not depend on the number of threads or on the instruction set.
  ///
  /// `guide_depth_m`: empty, or a depth image of the same field of view and any size. A ray then
  /// starts two truncation distances before the guide's depth, which is faster; where it finds no
  /// surface the whole ray is searched.
  /// @throws std::invalid_argument where the intrinsics or the pose are unusable
  SurfaceMap raycast(const TsdfVolume& volume, const Pose& X_WC, const Intrinsics& intrinsics,
                     const cv::Mat_<float>& guide_depth_m = {}) const;

 private:
  Config config_;
  InstructionSet instruction_set_;
};

}  // namespace kintsugi::mapper
