#pragma once

#include <cstdint>
#include <vector>

#include "lcmtypes/geometry.hpp"
#include "lcmtypes/messages.hpp"

namespace kintsugi::synthetic {
class Scene;
}

namespace kintsugi::mapper {

/// Distances of the points of a map from the true surface.
struct SurfaceError {
  std::int64_t num_points = 0;
  double mean_m = 0.0;
  double median_m = 0.0;
  double percentile_95_m = 0.0;
  double percentile_99_m = 0.0;
  double max_m = 0.0;
  double median_normal_deg = 0.0;         ///< between normal and true normal
  double percentile_95_normal_deg = 0.0;  ///< the same
  /// Median over the points of the number of points within 5 cm, divided by the area of a disc of
  /// that radius: the density on a plane, higher where surface was mapped twice.
  double points_per_m2 = 0.0;
};

/// Compares every point with the nearest surface of the scene, see Scene::signed_distance(). All
/// values are zero if there are no points.
/// @param X_SW pose of the map frame in the scene frame: that of the camera at the first frame, or
///   the identity if the mapper was given true poses
SurfaceError surface_error(const std::vector<CloudPoint>& points_W, const synthetic::Scene& scene,
                           const Pose& X_SW);

/// The error of each point, metres, positive in free space; in the order of the points.
std::vector<double> signed_errors_m(const std::vector<CloudPoint>& points_W,
                                    const synthetic::Scene& scene, const Pose& X_SW);

}  // namespace kintsugi::mapper
