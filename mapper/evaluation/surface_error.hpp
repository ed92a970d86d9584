#pragma once

#include <cstdint>
#include <vector>

#include "lcmtypes/geometry.hpp"
#include "lcmtypes/messages.hpp"

namespace kintsugi::synthetic {
class Scene;
}

namespace kintsugi::mapper {

/// How far the points of a map are from the true surface.
struct SurfaceError {
  std::int64_t num_points = 0;
  double mean_m = 0.0;
  double median_m = 0.0;
  double percentile_95_m = 0.0;
  double percentile_99_m = 0.0;
  double max_m = 0.0;
  double median_normal_deg = 0.0;         ///< between normal and true normal
  double percentile_95_normal_deg = 0.0;  ///< the same
  /// Median over the points of the number within 5 cm, over the area of that disc: on a plane the
  /// points of a square metre of surface (more where surface was mapped twice).
  double points_per_m2 = 0.0;
};

/// Every point against the nearest surface of the scene, in free space or within a solid: see
/// Scene::signed_distance(), which is exact but where solids touch within.
/// `X_SW` is the pose of the map's frame in the scene's: of the camera at the map's first frame,
/// where the mapper tracked; the identity where it was given true poses.
/// All zero for no points.
SurfaceError surface_error(const std::vector<CloudPoint>& points_W, const synthetic::Scene& scene,
                           const Pose& X_SW);

/// The error of each point, metres, positive in free space; in the order of the points.
std::vector<double> signed_errors_m(const std::vector<CloudPoint>& points_W,
                                    const synthetic::Scene& scene, const Pose& X_SW);

}  // namespace kintsugi::mapper
