#include "mapper/core/registration/edge_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "lcmtypes/base/argument_check.hpp"
#include "mapper/core/frame/camera.hpp"
#include "mapper/core/registration/pose_uncertainty.hpp"

namespace kintsugi::mapper {
namespace {

/// An outline's pixel of the frame and the outline of the model near it.
struct EdgePair {
  Eigen::Vector3f p_V;
  float residual_px = 0.0F;
  float slope_V = 0.0F;
  float slope_C = 0.0F;
  int axis = 0;  ///< 0 where lines are rows, 1 where they are columns
};

class EdgeMatcher {
 public:
  EdgeMatcher(const SurfaceMap& frame_C, const SurfaceMap& model_V, const Pose& X_VC,
              const EdgeAlignmentConfig& config)
      : camera_C_(pinhole_camera(frame_C.intrinsics)),
        camera_V_(pinhole_camera(model_V.intrinsics)),
        noise_(frame_C.noise),
        X_VC_(X_VC.cast<float>()),
        config_(config) {}

  void match(const EdgeLines& lines_C, const EdgeLines& lines_V, int axis) {
    for (std::size_t line = 0; line < lines_C.size(); ++line) {
      for (const EdgePixel& edge : lines_C[line]) {
        match(edge, static_cast<float>(line), lines_V, axis);
      }
    }
  }

  const std::vector<EdgePair>& pairs() const { return pairs_; }

 private:
  void match(const EdgePixel& edge, float line, const EdgeLines& lines_V, int axis) {
    const float u = axis == 0 ? edge.position_px : line;
    const float v = axis == 0 ? line : edge.position_px;
    const Eigen::Vector3f ray_C((u - camera_C_.cx) * camera_C_.inverse_fx,
                                (v - camera_C_.cy) * camera_C_.inverse_fy, 1.0F);
    const Eigen::Vector3f p = X_VC_ * (edge.depth_m * ray_C);
    if (!(p.z() > 0.0F)) return;
    const Eigen::Vector2f seen(camera_V_.fx * p.x() / p.z() + camera_V_.cx,
                               camera_V_.fy * p.y() / p.z() + camera_V_.cy);
    const float across = seen[1 - axis];
    const auto nearest_line = static_cast<std::ptrdiff_t>(std::lround(across));
    if (nearest_line < 0 || nearest_line >= static_cast<std::ptrdiff_t>(lines_V.size())) return;
    const float off_line = across - static_cast<float>(nearest_line);
    const EdgePixel* best = nullptr;
    auto residual = static_cast<float>(config_.max_distance_px);
    for (const EdgePixel& candidate : lines_V[nearest_line]) {
      if (candidate.ends != edge.ends || !is_as_deep(candidate, p.z())) continue;
      const float distance = candidate.position_px + candidate.slope * off_line - seen[axis];
      if (std::abs(distance) >= std::abs(residual)) continue;
      best = &candidate;
      residual = distance;
    }
    if (best != nullptr) pairs_.push_back({p, residual, best->slope, edge.slope, axis});
  }

  bool is_as_deep(const EdgePixel& edge, float depth_m) const {
    const double largest_step_m =
        config_.depth_sigmas * noise_.sigma_m(depth_m) + config_.max_depth_share * depth_m;
    return std::abs(edge.depth_m - depth_m) < static_cast<float>(largest_step_m);
  }

  PinholeCamera camera_C_;
  PinholeCamera camera_V_;
  DepthNoise noise_;
  Eigen::Isometry3f X_VC_;
  EdgeAlignmentConfig config_;
  std::vector<EdgePair> pairs_;
};

/// Derivative of (position - slope line) with respect to the point.
Eigen::Vector3f by_point(const PinholeCamera& camera, const Eigen::Vector3f& p, float slope,
                         int axis) {
  const float fu = camera.fx * (axis == 0 ? 1.0F : -slope) / p.z();
  const float fv = camera.fy * (axis == 0 ? -slope : 1.0F) / p.z();
  return {fu, fv, -(fu * p.x() + fv * p.y()) / p.z()};
}

/// The deviation of the residuals, from their median.
float deviation_px(const std::vector<EdgePair>& pairs, const EdgeAlignmentConfig& config) {
  constexpr float kDeviationOfMedian = 1.4826F;  // of normally distributed numbers
  std::vector<float> amounts;
  amounts.reserve(pairs.size());
  for (const EdgePair& pair : pairs) amounts.push_back(std::abs(pair.residual_px));
  const auto middle = amounts.begin() + static_cast<std::ptrdiff_t>(amounts.size() / 2);
  std::nth_element(amounts.begin(), middle, amounts.end());
  return std::max(static_cast<float>(config.min_sigma_px), kDeviationOfMedian * *middle);
}

}  // namespace

void EdgeAlignmentConfig::validate() const {
  check_range("edge min_sigma_px", min_sigma_px, 1e-3, 1e3);
  check_range("edge max_distance_px", max_distance_px, 0.5, 1e3);
  check_range("edge huber_sigmas", huber_sigmas, 1e-3, 1e6);
  check_range("edge depth_sigmas", depth_sigmas, 0.0, 1e3);
  check_range("edge max_depth_share", max_depth_share, 0.0, 1.0);
}

EdgeEquations linearize_edges(const DepthEdges& edges_C, const SurfaceMap& frame_C,
                              const DepthEdges& edges_V, const SurfaceMap& model_V,
                              const Pose& X_VC, const EdgeAlignmentConfig& config) {
  EdgeMatcher matcher(frame_C, model_V, X_VC, config);
  matcher.match(edges_C.rows, edges_V.rows, 0);
  matcher.match(edges_C.columns, edges_V.columns, 1);
  EdgeEquations equations;
  equations.pairs = static_cast<int>(matcher.pairs().size());
  if (equations.pairs == 0) return equations;

  const PinholeCamera camera = pinhole_camera(model_V.intrinsics);
  const float sigma_px = deviation_px(matcher.pairs(), config);
  const float huber_px = static_cast<float>(config.huber_sigmas) * sigma_px;
  InformationSum sum;
  for (const EdgePair& pair : matcher.pairs()) {
    const float excess = std::max(std::abs(pair.residual_px) / huber_px, 1.0F);
    const float weight = 1.0F / (excess * sigma_px * sigma_px);
    const Vector6f row =
        increment_row(by_point(camera, pair.p_V, pair.slope_V, pair.axis), pair.p_V);
    const Vector6f other_row =
        increment_row(by_point(camera, pair.p_V, pair.slope_C, pair.axis), pair.p_V);
    sum.add(row, other_row, weight);
    equations.b += (weight * pair.residual_px * row).cast<double>();
  }
  sum.add_to(equations.information);
  return equations;
}

double weight_of_edges(std::size_t num_pixels) {
  return std::sqrt(static_cast<double>(num_pixels) / kIndependentPatches);
}

}  // namespace kintsugi::mapper
