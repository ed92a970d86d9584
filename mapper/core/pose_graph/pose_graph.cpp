#include "mapper/core/pose_graph/pose_graph.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include "lcmtypes/base/argument_check.hpp"

namespace kintsugi::mapper {
namespace {

constexpr int kNumParameters = 7;  // translation, and the quaternion x y z w

[[noreturn]] void refuse(const std::string& what) {
  throw std::invalid_argument("PoseGraph: " + what);
}

/// S with S^T S = information, also where that is not of full rank.
Matrix6d square_root(const Matrix6d& information) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(information);
  return eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() *
         eigen.eigenvectors().transpose();
}

/// pose_error() times the square root of the information, for automatic differentiation.
struct WeightedError {
  Eigen::Vector3d t_FT;  ///< measured
  Eigen::Quaterniond q_FT;
  Matrix6d weight;

  template <typename T>
  bool operator()(const T* from, const T* to, T* weighted) const {
    using Vector = Eigen::Matrix<T, 3, 1>;
    using Quaternion = Eigen::Quaternion<T>;
    const Eigen::Map<const Vector> t_WF(from);
    const Eigen::Map<const Vector> t_WT(to);
    const Eigen::Map<const Quaternion> q_WF(from + 3);
    const Eigen::Map<const Quaternion> q_WT(to + 3);
    const Quaternion q_TmF = q_FT.conjugate().cast<T>();
    const Vector t_believed_F = q_WF.conjugate() * (t_WT - t_WF);
    const Vector translation = q_TmF * Vector(t_believed_F - t_FT.cast<T>());
    const Quaternion rotation = q_TmF * (q_WF.conjugate() * q_WT);
    const std::array<T, 4> w_first = {rotation.w(), rotation.x(), rotation.y(), rotation.z()};
    std::array<T, 3> angle_axis;
    ceres::QuaternionToAngleAxis(w_first.data(), angle_axis.data());
    Eigen::Matrix<T, 6, 1> error;
    error << translation, angle_axis[0], angle_axis[1], angle_axis[2];
    Eigen::Map<Eigen::Matrix<T, 6, 1>> result(weighted);
    result = weight.cast<T>() * error;
    return true;
  }
};

using Parameters = std::array<double, kNumParameters>;

Parameters parameters_of(const Pose& X_WN) {
  const Eigen::Quaterniond q(X_WN.linear());
  const Eigen::Vector3d t = X_WN.translation();
  return {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()};
}

Pose pose_of(const Parameters& p) {
  Pose X_WN = Pose::Identity();
  X_WN.translation() = Eigen::Vector3d(p[0], p[1], p[2]);
  X_WN.linear() = Eigen::Quaterniond(p[6], p[3], p[4], p[5]).normalized().toRotationMatrix();
  return X_WN;
}

ceres::Solver::Options solver_options(const PoseGraphConfig& config) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.num_threads = 1;
  options.max_num_iterations = config.max_iterations;
  // Odometry starts at the bottom of a valley that the loops only move, so the first steps are
  // trusted; damped ones took as many iterations again.
  options.initial_trust_region_radius = 1e9;
  // Under Cauchy's loss the steps halve in the end; what is left then moves no node by a tenth of
  // a millimetre.
  options.function_tolerance = 1e-10;
  options.parameter_tolerance = 1e-10;
  options.logging_type = ceres::SILENT;
  return options;
}

}  // namespace

void PoseGraph::validate() const {
  for (std::size_t i = 0; i < X_WN.size(); ++i) {
    if (!X_WN[i].matrix().allFinite()) refuse("node " + std::to_string(i) + " is not finite");
  }
  const auto check_node = [this](const std::string& name, int node) {
    if (node >= 0 && static_cast<std::size_t>(node) < X_WN.size()) return;
    refuse(name + " is at node " + std::to_string(node) + ", there are " +
           std::to_string(X_WN.size()));
  };
  for (const int node : fixed) check_node("what is fixed", node);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const PoseEdge& edge = edges[i];
    const std::string name = "edge " + std::to_string(i);
    check_node(name, edge.from);
    check_node(name, edge.to);
    if (edge.from == edge.to) {
      refuse(name + " is from node " + std::to_string(edge.from) + " to itself");
    }
    if (!edge.X_FT.matrix().allFinite()) refuse(name + " has a pose that is not finite");
    const Matrix6d& information = edge.information;
    const double most = information.cwiseAbs().maxCoeff();
    if (!information.allFinite() || !information.isApprox(information.transpose(), 1e-9)) {
      refuse(name + " has an information that is not finite and symmetric");
    }
    const double least =
        Eigen::SelfAdjointEigenSolver<Matrix6d>(information).eigenvalues().minCoeff();
    if (least < -1e-9 * most) {
      refuse(name + " has an information with the eigenvalue " + std::to_string(least) +
             ", expected none below 0");
    }
  }
}

void PoseGraphConfig::validate() const {
  check_range("loop_scale_sigmas", loop_scale_sigmas, 0.1, 1e3);
  check_range("contradicted_sigmas", contradicted_sigmas, 0.1, 1e3);
  check_range("max_iterations", max_iterations, 1, 10'000);
}

Vector6d pose_error(const Pose& X_FT_measured, const Pose& X_FT) {
  const Pose difference = X_FT_measured.inverse(Eigen::Isometry) * X_FT;
  const Eigen::AngleAxisd rotation(difference.linear());
  Vector6d error;
  error << difference.translation(), rotation.angle() * rotation.axis();
  return error;
}

OptimizedPoses optimize(const PoseGraph& graph, const PoseGraphConfig& config) {
  config.validate();
  OptimizedPoses result;
  result.X_WN = graph.X_WN;
  result.converged = true;
  if (graph.X_WN.empty()) return result;
  graph.validate();

  std::vector<Parameters> nodes;
  nodes.reserve(graph.X_WN.size());
  for (const Pose& X_WN : graph.X_WN) nodes.push_back(parameters_of(X_WN));
  ceres::ProductManifold<ceres::EuclideanManifold<3>, ceres::EigenQuaternionManifold> manifold;
  ceres::CauchyLoss loop_loss(config.loop_scale_sigmas);
  ceres::Problem::Options ownership;
  ownership.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  for (Parameters& node : nodes) {
    problem.AddParameterBlock(node.data(), kNumParameters, &manifold);
  }
  for (const int node : graph.fixed) {
    problem.SetParameterBlockConstant(nodes[static_cast<std::size_t>(node)].data());
  }
  for (const PoseEdge& edge : graph.edges) {
    auto* const error =
        new WeightedError{edge.X_FT.translation(), Eigen::Quaterniond(edge.X_FT.linear()),
                          square_root(edge.information)};
    // The problem owns the cost function, and that the error.
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<WeightedError, 6, kNumParameters, kNumParameters>(error),
        edge.is_loop ? &loop_loss : nullptr, nodes[static_cast<std::size_t>(edge.from)].data(),
        nodes[static_cast<std::size_t>(edge.to)].data());
  }
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(config), &problem, &summary);

  result.converged = summary.termination_type == ceres::CONVERGENCE;
  result.num_iterations = static_cast<int>(summary.iterations.size()) - 1;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (std::ranges::find(graph.fixed, static_cast<int>(i)) == graph.fixed.end()) {
      result.X_WN[i] = pose_of(nodes[i]);
    }
  }
  for (std::size_t i = 0; i < graph.edges.size(); ++i) {
    const PoseEdge& edge = graph.edges[i];
    const Pose X_FT = result.X_WN[static_cast<std::size_t>(edge.from)].inverse(Eigen::Isometry) *
                      result.X_WN[static_cast<std::size_t>(edge.to)];
    const Vector6d error = pose_error(edge.X_FT, X_FT);
    result.error_sigmas.push_back(std::sqrt(std::max(0.0, error.dot(edge.information * error))));
    const bool is_far = result.error_sigmas.back() > config.contradicted_sigmas;
    if (edge.is_loop && is_far) result.contradicted.push_back(static_cast<int>(i));
  }
  return result;
}

}  // namespace kintsugi::mapper
