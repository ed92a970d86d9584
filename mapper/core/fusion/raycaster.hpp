#pragma once

#include <optional>

#include <opencv2/core.hpp>

#include "lcmtypes/geometry.hpp"
#include "mapper/core/frame/surface_map.hpp"
#include "mapper/core/kernels/instruction_set.hpp"

namespace kintsugi::mapper {

class TsdfVolume;

/// The surface of the volume as a camera would see it.
class Raycaster {
 public:
  struct Config {
    double min_depth_m = 0.3;                            ///< rays start here at the earliest
    double max_depth_m = 6.0;                            ///< and end here
    std::optional<InstructionSet> instruction_set = {};  ///< none: best_instruction_set()

    /// @throws std::invalid_argument naming the field, its value and the bound.
    void validate() const;
  };

  explicit Raycaster(const Config& config);

  /// The first crossing from free space into a surface along each pixel's ray, at the resolution of
  /// `intrinsics` (no distortion), and the normals of these points as surface_from_depth() takes
  /// them from their neighbours. They are as accurate as the gradient of the distance there and
  /// cost a tenth of it. A pixel without a crossing is NaN. The same bytes whatever the number of
  /// threads and the instruction set.
  ///
  /// `guide_depth_m`: empty, or a depth image of the same field of view and any size; a ray starts
  /// two truncation distances before the guide's depth, which is faster and gives the same surface
  /// where the volume agrees with the guide; where it does not, the whole ray is searched.
  /// @throws std::invalid_argument where the intrinsics or the pose are unusable.
  SurfaceMap raycast(const TsdfVolume& volume, const Pose& X_WC, const Intrinsics& intrinsics,
                     const cv::Mat_<float>& guide_depth_m = {}) const;

 private:
  Config config_;
  InstructionSet instruction_set_;
};

}  // namespace kintsugi::mapper
