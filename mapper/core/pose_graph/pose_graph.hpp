#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "lcmtypes/geometry.hpp"
#include "mapper/core/registration/twist.hpp"

namespace kintsugi::mapper {

/// A measurement of the pose of one node in another.
struct PoseEdge {
  int from = 0;
  int to = 0;
  Pose X_FT = Pose::Identity();  ///< measured: the pose of node `to` in node `from`
  /// Inverse covariance of pose_error(), translation (1/m^2) before rotation (1/rad^2); symmetric,
  /// no eigenvalue below zero. Zero along what the measurement does not know.
  Matrix6d information = Matrix6d::Identity();
  bool is_loop = false;  ///< found by comparison, so that it may be wrong; not from tracking
};

/// Keyframes, and what is known of the motion between them.
struct PoseGraph {
  std::vector<Pose> X_WN;  ///< poses of the nodes as they are believed
  std::vector<PoseEdge> edges;
  std::vector<int> fixed = {0};  ///< nodes that never move: one of those that edges connect

  /// @throws std::invalid_argument naming the edge or node, the value and what was expected
  void validate() const;
};

/// How far `X_FT` is from what was measured: translation (m) and rotation vector (rad) of
/// measured^-1 X_FT.
Vector6d pose_error(const Pose& X_FT_measured, const Pose& X_FT);

struct PoseGraphConfig {
  /// Errors of loops above so many standard deviations count less and less (Cauchy), so that a
  /// wrong loop pulls with a bounded force. The square is the 95 % quantile of the chi-squared
  /// distribution with the six degrees of freedom of a pose.
  double loop_scale_sigmas = 3.5485;
  /// A loop that is farther than this from the optimised poses is contradicted by the rest of the
  /// graph. The square is the 99.9 % quantile.
  double contradicted_sigmas = 4.7389;
  int max_iterations = 100;

  /// @throws std::invalid_argument naming field, value and bound
  void validate() const;
};

struct OptimizedPoses {
  std::vector<Pose> X_WN;            ///< of the nodes
  std::vector<double> error_sigmas;  ///< of each edge: standard deviations from its measurement
  std::vector<int> contradicted;     ///< loops, numbers of edges, ascending
  bool converged = false;            ///< otherwise the best poses after max_iterations
  int num_iterations = 0;
};

/// Moves the nodes to where the edges want them: the poses of least summed squared error, weighted
/// by the information of the edges. On one thread; the same graph gives the same bits.
///
/// A node without a path of edges to a fixed one keeps its believed pose relative to the nodes that
/// it does have edges with, as far as these allow.
/// @throws std::invalid_argument when graph or configuration are not valid
OptimizedPoses optimize(const PoseGraph& graph, const PoseGraphConfig& config = {});

}  // namespace kintsugi::mapper
