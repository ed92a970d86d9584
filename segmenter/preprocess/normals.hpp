#pragma once
// Computes normals for clouds that have none.

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

struct NormalsConfig {
  int num_neighbours = 20;  ///< k of the principal component analysis, >= 3
  /// Normals are turned towards this point, W, where the sensor was. By default the mean of all
  /// points, which suits a room seen from inside.
  std::optional<Eigen::Vector3d> viewpoint_W = std::nullopt;

  /// @throws std::invalid_argument naming field, value and bound
  void validate() const;
};

/// Sets the normal of each point to the direction of least variance among its k nearest neighbours
/// and itself (principal component analysis), and orients the normals consistently.
///
/// Orientation: along a minimum spanning forest of the neighbour graph whose edges cost
/// 1 - |n_i . n_j|, a normal is turned to agree with its neighbour's (Hoppe et al. 1992); each tree
/// is then turned as a whole so that most of its normals face the viewpoint.
///
/// If a neighbourhood lies on a line or in one place, the normal of its point becomes zero.
/// The result does not depend on the number of threads.
///
/// @param points_W all with finite positions
/// @param progress called from one thread with the share of the work that is done, 0 to 1
/// @return the number of points without a normal
std::int64_t estimate_normals(std::span<CloudPoint> points_W, const NormalsConfig& config,
                              const std::function<void(double)>& progress = {});

/// Sets the normals that are missing, of length 0 or NaN, as estimate_normals() does, and turns
/// each so that it agrees with the sum of those that its neighbours have already. The others stay.
///
/// @param points_W all with finite positions
void estimate_missing_normals(std::span<CloudPoint> points_W, const NormalsConfig& config);

/// Whether a point has no normal: it is of length 0, or not finite.
bool lacks_normal(const CloudPoint& point);

}  // namespace kintsugi::segmenter
