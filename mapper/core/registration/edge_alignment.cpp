#include "mapper/core/registration/edge_alignment.hpp"

#include <cmath>

#include "lcmtypes/base/argument_check.hpp"
#include "mapper/core/frame/camera.hpp"
#include "mapper/core/registration/pose_uncertainty.hpp"

namespace kintsugi::mapper {
namespace {

class EdgePairs {
 public:
  EdgePairs(const SurfaceMap& frame_C, const SurfaceMap& model_V, const Pose& X_VC,
            const EdgeAlignmentConfig& config, EdgeEquations& equations)
      : camera_C_(pinhole_camera(frame_C.intrinsics)),
        camera_V_(pinhole_camera(model_V.intrinsics)),
        noise_(frame_C.noise),
        X_VC_(X_VC.cast<float>()),
        config_(config),
        equations_(equations) {}

  /// `axis`: 0 where the lines are rows, 1 where they are columns.
  void add(const std::vector<std::vector<EdgePixel>>& lines_C,
           const std::vector<std::vector<EdgePixel>>& lines_V, int axis) {
    for (std::size_t line = 0; line < lines_C.size(); ++line) {
      for (const EdgePixel& edge : lines_C[line]) {
        add_edge(edge, static_cast<float>(line), lines_V, axis);
      }
    }
  }

 private:
  void add_edge(const EdgePixel& edge, float line,
                const std::vector<std::vector<EdgePixel>>& lines_V, int axis) {
    const float u = axis == 0 ? edge.position_px : line;
    const float v = axis == 0 ? line : edge.position_px;
    const Eigen::Vector3f point_C =
        edge.depth_m * Eigen::Vector3f((u - camera_C_.cx) * camera_C_.inverse_fx,
                                       (v - camera_C_.cy) * camera_C_.inverse_fy, 1.0F);
    const Eigen::Vector3f p = X_VC_ * point_C;
    if (!(p.z() > 0.0F)) return;
    const Eigen::Vector2f seen(camera_V_.fx * p.x() / p.z() + camera_V_.cx,
                               camera_V_.fy * p.y() / p.z() + camera_V_.cy);
    const float along = seen[axis];
    const float across = seen[1 - axis];
    const auto nearest_line = static_cast<std::ptrdiff_t>(std::lround(across));
    if (nearest_line < 0 || nearest_line >= static_cast<std::ptrdiff_t>(lines_V.size())) return;
    const float off_line = across - static_cast<float>(nearest_line);
    const EdgePixel* best = nullptr;
    float residual = static_cast<float>(config_.max_distance_px);
    const float depth_step_m = max_depth_step_m(p.z());
    for (const EdgePixel& candidate : lines_V[nearest_line]) {
      if (candidate.ends != edge.ends || !(std::abs(candidate.depth_m - p.z()) < depth_step_m))
        continue;
      const float distance = candidate.position_px + candidate.slope * off_line - along;
      if (std::abs(distance) >= std::abs(residual)) continue;
      best = &candidate;
      residual = distance;
    }
    if (best == nullptr) return;
    add_pair(p, residual, best->slope, edge.slope, axis);
  }

  void add_pair(const Eigen::Vector3f& p, float residual, float slope, float frame_slope,
                int axis) {
    const auto sigma = static_cast<float>(config_.sigma_px);
    const auto huber = static_cast<float>(config_.huber_sigmas) * sigma;
    const float weight =
        std::min(1.0F, huber / std::max(std::abs(residual), 1e-6F)) / (sigma * sigma);
    const Vector6f row = increment_row(by_point(p, slope, axis), p);
    sum_.add(row, increment_row(by_point(p, frame_slope, axis), p), weight);
    equations_.b += (weight * residual * row).cast<double>();
    ++equations_.pairs;
  }

  /// Derivative of (position - slope line) with respect to the point.
  Eigen::Vector3f by_point(const Eigen::Vector3f& p, float slope, int axis) const {
    const float fu = camera_V_.fx * (axis == 0 ? 1.0F : -slope) / p.z();
    const float fv = camera_V_.fy * (axis == 0 ? -slope : 1.0F) / p.z();
    return {fu, fv, -(fu * p.x() + fv * p.y()) / p.z()};
  }

  float max_depth_step_m(float depth_m) const {
    return static_cast<float>(config_.depth_sigmas * noise_.sigma_m(depth_m) +
                              config_.max_depth_share * depth_m);
  }

 public:
  InformationSum sum_;

 private:
  PinholeCamera camera_C_;
  PinholeCamera camera_V_;
  DepthNoise noise_;
  Eigen::Isometry3f X_VC_;
  EdgeAlignmentConfig config_;
  EdgeEquations& equations_;
};

}  // namespace

void EdgeAlignmentConfig::validate() const {
  check_range("edge sigma_px", sigma_px, 1e-3, 1e3);
  check_range("edge max_distance_px", max_distance_px, 0.5, 1e3);
  check_range("edge huber_sigmas", huber_sigmas, 1e-3, 1e6);
  check_range("edge depth_sigmas", depth_sigmas, 0.0, 1e3);
  check_range("edge max_depth_share", max_depth_share, 0.0, 1.0);
}

EdgeEquations linearize_edges(const DepthEdges& edges_C, const SurfaceMap& frame_C,
                              const DepthEdges& edges_V, const SurfaceMap& model_V,
                              const Pose& X_VC, const EdgeAlignmentConfig& config) {
  EdgeEquations equations;
  EdgePairs pairs(frame_C, model_V, X_VC, config, equations);
  pairs.add(edges_C.rows, edges_V.rows, 0);
  pairs.add(edges_C.columns, edges_V.columns, 1);
  pairs.sum_.add_to(equations.information);
  return equations;
}

double weight_of_edges(std::size_t num_pixels) {
  return std::sqrt(static_cast<double>(num_pixels) / kIndependentPatches);
}

}  // namespace kintsugi::mapper
