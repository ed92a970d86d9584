#include "viewer/core/camera/viewpoint.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <vector>

#include "lcmtypes/base/argument_check.hpp"

namespace kintsugi::viewer {
namespace {

/// Six finite numbers with commas between them and nothing else.
std::optional<std::array<double, 6>> parse_six_numbers(const std::string& text) {
  std::array<double, 6> numbers{};
  const char* at = text.data();
  const char* const end = text.data() + text.size();
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (i > 0) {
      if (at == end || *at != ',') return std::nullopt;
      ++at;
    }
    const auto [next, error] = std::from_chars(at, end, numbers[i]);
    if (error != std::errc() || !std::isfinite(numbers[i])) return std::nullopt;
    at = next;
  }
  return at == end ? std::optional(numbers) : std::nullopt;
}

/// An even subset of the finite points whose normals do not face away from a camera that looks
/// along `forward_W`.
std::vector<Eigen::Vector3d> sample(std::span<const PointChunk> chunks,
                                    const Eigen::Vector3d& forward_W) {
  constexpr std::size_t kEnough = 50'000;  // to fit a view to within a pixel or so
  std::size_t total = 0;
  for (const PointChunk& chunk : chunks) total += chunk.points_W.size();
  const std::size_t step = 1 + total / kEnough;
  std::vector<Eigen::Vector3d> points_W;
  for (const PointChunk& chunk : chunks) {
    for (std::size_t i = 0; i < chunk.points_W.size(); i += step) {
      const CloudPoint& p = chunk.points_W[i];
      if (forward_W.dot(Eigen::Vector3d(p.nx, p.ny, p.nz)) > 0.0) continue;
      const Eigen::Vector3d p_W(p.x, p.y, p.z);
      if (p_W.allFinite()) points_W.push_back(p_W);
    }
  }
  return points_W;
}

/// The camera with this orientation in whose picture all points fit that face it, but for a few
/// outliers; at W's origin when there is nothing.
VirtualCamera camera_around(std::span<const PointChunk> chunks, const Eigen::Matrix3d& R_WV,
                            const Intrinsics& intrinsics, const ViewpointConfig& config,
                            std::span<const Eigen::Vector3d> all_of_these_W) {
  constexpr double kOutliers = 0.0002;  // share of the points, at each side
  const std::vector<Eigen::Vector3d> points_W = sample(chunks, R_WV.col(2));
  if (points_W.empty() && all_of_these_W.empty()) {
    VirtualCamera camera{intrinsics, Pose::Identity()};
    camera.X_WV.linear() = R_WV;
    return camera;
  }
  return fit_points(points_W, kOutliers, R_WV, intrinsics, config.margin_px, all_of_these_W);
}

VirtualCamera overview(const ReceivedMap& map, std::int32_t part, const Intrinsics& intrinsics,
                       const ViewpointConfig& config,
                       std::span<const Eigen::Vector3d> all_of_these_W) {
  const Eigen::Matrix3d R_WV =
      look_down(map.up(part).up_W(), config.overview_yaw_rad, config.overview_pitch_rad);
  return camera_around(map.chunks(part), R_WV, intrinsics, config, all_of_these_W);
}

VirtualCamera follow(const ReceivedMap& map, std::int32_t part, const SmoothedCamera& depth_camera,
                     const Intrinsics& intrinsics, const ViewpointConfig& config,
                     std::span<const Eigen::Vector3d> all_of_these_W) {
  const Eigen::Vector3d up_W = map.up(part).up_W();
  const Eigen::Vector3d forward_W = std::cos(config.follow_pitch_rad) * depth_camera.heading_W() -
                                    std::sin(config.follow_pitch_rad) * up_W;
  const Eigen::Matrix3d R_WV = look_at(Eigen::Vector3d::Zero(), forward_W, up_W).linear();
  std::vector<Eigen::Vector3d> points_W = sample(map.chunks(part), forward_W);
  std::erase_if(points_W, [&](const Eigen::Vector3d& p_W) {
    return (p_W - depth_camera.position_W()).norm() > config.follow_radius_m;
  });
  points_W.push_back(depth_camera.position_W());
  return fit_points(points_W, 0.0, R_WV, intrinsics, config.margin_px, all_of_these_W);
}

}  // namespace

void ViewpointConfig::validate() const {
  require(field_of_view_rad > 0.0 && field_of_view_rad < 3.0, "ViewpointConfig::field_of_view_rad",
          field_of_view_rad, "in (0, 3)");
  require(follow_radius_m > 0.0 && follow_radius_m <= 1000.0, "ViewpointConfig::follow_radius_m",
          follow_radius_m, "in (0, 1000]");
  check_range("ViewpointConfig::follow_pitch_rad", follow_pitch_rad, -1.5, 1.5);
  require(std::isfinite(overview_yaw_rad), "ViewpointConfig::overview_yaw_rad", overview_yaw_rad,
          "a finite angle");
  check_range("ViewpointConfig::overview_pitch_rad", overview_pitch_rad, -1.5, 1.5);
  require(margin_px >= 0.0, "ViewpointConfig::margin_px", margin_px, ">= 0");
}

Viewpoint parse_viewpoint(const std::string& text) {
  if (text == "follow") return FollowViewpoint{};
  if (text == "overview") return OverviewViewpoint{};
  const auto numbers = parse_six_numbers(text);
  require(numbers.has_value(), "view", '"' + text + '"',
          "follow, overview or x,y,z,lookx,looky,lookz (metres)");
  FixedViewpoint fixed{Eigen::Vector3d(numbers->data()), Eigen::Vector3d(numbers->data() + 3)};
  require((fixed.target_W - fixed.eye_W).norm() >= 1e-6, "view", '"' + text + '"',
          "a target apart from the eye");
  return fixed;
}

std::optional<VirtualCamera> close_up(std::span<const PointChunk> chunks,
                                      const std::set<std::uint32_t>& segments,
                                      const Eigen::Matrix3d& R_WV, const Intrinsics& intrinsics) {
  constexpr double kSurroundings = 0.12;  // of the picture's height, on each side
  if (segments.empty()) return std::nullopt;
  std::vector<Eigen::Vector3d> points_W;
  for (const PointChunk& chunk : chunks) {
    for (std::size_t i = 0; i < chunk.points_W.size(); ++i) {
      const CloudPoint& p = chunk.points_W[i];
      const Eigen::Vector3d p_W(p.x, p.y, p.z);
      if (segments.contains(chunk.labels[i]) && p_W.allFinite()) points_W.push_back(p_W);
    }
  }
  if (points_W.empty()) return std::nullopt;
  return fit_points(points_W, 0.0, R_WV, intrinsics, kSurroundings * intrinsics.height);
}

VirtualCamera camera_at(const Viewpoint& viewpoint, const ReceivedMap& map, std::int32_t part,
                        const SmoothedCamera& depth_camera, int width_px, int height_px,
                        const ViewpointConfig& config,
                        std::span<const Eigen::Vector3d> all_of_these_W) {
  const Intrinsics intrinsics = pinhole(width_px, height_px, config.field_of_view_rad);
  if (const auto* fixed = std::get_if<FixedViewpoint>(&viewpoint)) {
    return {intrinsics, look_at(fixed->eye_W, fixed->target_W, map.up(part).up_W())};
  }
  if (std::holds_alternative<FollowViewpoint>(viewpoint) && depth_camera.has_pose()) {
    return follow(map, part, depth_camera, intrinsics, config, all_of_these_W);
  }
  return overview(map, part, intrinsics, config, all_of_these_W);
}

}  // namespace kintsugi::viewer
