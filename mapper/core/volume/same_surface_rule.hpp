#pragma once

namespace kintsugi::mapper {

/// When two surfaces are the same one.
struct SameSurface {
  double max_distance_vox = 1.5;
  double max_angle_deg = 30.0;  ///< between the normals
  int weight_threshold = 8;     ///< observations of voxels that count, as of points

  /// @throws std::invalid_argument naming field, value and bound
  void validate() const;
};

}  // namespace kintsugi::mapper
