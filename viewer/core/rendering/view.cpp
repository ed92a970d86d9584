#include "viewer/core/rendering/view.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <stdexcept>
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

/// Points spread evenly over the map, of those whose normals do not face along `forward_W`: what a
/// camera looking there can see. What is not finite is not drawn either.
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

VirtualCamera overview(const Scene& scene, const Intrinsics& intrinsics, const ViewConfig& config) {
  const Eigen::Matrix3d R_WV =
      look_down(scene.up().up_W(), config.overview_yaw_rad, config.overview_pitch_rad);
  return camera_around(scene.chunks(), R_WV, intrinsics, config);
}

VirtualCamera follow(const Scene& scene, const FollowedCamera& followed,
                     const Intrinsics& intrinsics, const ViewConfig& config) {
  const Eigen::Vector3d up_W = scene.up().up_W();
  const Eigen::Vector3d forward_W = std::cos(config.follow_pitch_rad) * followed.heading_W() -
                                    std::sin(config.follow_pitch_rad) * up_W;
  const Eigen::Matrix3d R_WV = look_at(Eigen::Vector3d::Zero(), forward_W, up_W).linear();
  std::vector<Eigen::Vector3d> points_W = sample(scene.chunks(), forward_W);
  std::erase_if(points_W, [&](const Eigen::Vector3d& p_W) {
    return (p_W - followed.position_W()).norm() > config.follow_radius_m;
  });
  points_W.push_back(followed.position_W());
  return fit_points(points_W, 0.0, R_WV, intrinsics, config.margin_px);
}

}  // namespace

void ViewConfig::validate() const {
  require(field_of_view_rad > 0.0 && field_of_view_rad < 3.0, "ViewConfig::field_of_view_rad",
          field_of_view_rad, "in (0, 3)");
  require(follow_radius_m > 0.0 && follow_radius_m <= 1000.0, "ViewConfig::follow_radius_m",
          follow_radius_m, "in (0, 1000]");
  require(std::abs(follow_pitch_rad) <= 1.5, "ViewConfig::follow_pitch_rad", follow_pitch_rad,
          "in [-1.5, 1.5]");
  require(std::isfinite(overview_yaw_rad), "ViewConfig::overview_yaw_rad", overview_yaw_rad,
          "a finite angle");
  require(std::abs(overview_pitch_rad) <= 1.5, "ViewConfig::overview_pitch_rad", overview_pitch_rad,
          "in [-1.5, 1.5]");
  require(margin_px >= 0.0, "ViewConfig::margin_px", margin_px, ">= 0");
}

View parse_view(const std::string& text) {
  if (text == "follow") return FollowView{};
  if (text == "overview") return OverviewView{};
  const auto numbers = parse_six_numbers(text);
  if (!numbers) {
    throw std::invalid_argument(
        "view is \"" + text + "\", expected follow, overview or x,y,z,lookx,looky,lookz (metres)");
  }
  FixedView view{Eigen::Vector3d(numbers->data()), Eigen::Vector3d(numbers->data() + 3)};
  if ((view.target_W - view.eye_W).norm() < 1e-6) {
    throw std::invalid_argument("view is \"" + text + "\": it looks at the point where it stands");
  }
  return view;
}

void FollowedCamera::update(const CameraPose& pose, const Eigen::Vector3d& up_W) {
  if (!is_located(pose.state)) return;
  if (has_pose() && pose.utime <= utime_) return;
  constexpr double kTimeConstant_s = 1.0;
  const Eigen::Vector3d position_W = pose.X_WC.translation();
  const Eigen::Vector3d forward_W = pose.X_WC.linear().col(2);
  Eigen::Vector3d heading_W = forward_W - forward_W.dot(up_W) * up_W;

  const bool first = !has_pose();
  const double elapsed_s = 1e-6 * static_cast<double>(pose.utime - utime_);
  const double gain = first ? 1.0 : 1.0 - std::exp(-elapsed_s / kTimeConstant_s);
  utime_ = std::max<std::int64_t>(pose.utime, 1);
  position_W_ += gain * (position_W - position_W_);
  if (heading_W.norm() < 0.1) return;  // looks up or down: no heading to speak of
  heading_W.normalize();
  const Eigen::Vector3d turned_W = heading_W_ + gain * (heading_W - heading_W_);
  heading_W_ = turned_W.norm() > 1e-3 ? Eigen::Vector3d(turned_W.normalized()) : heading_W;
}

VirtualCamera camera_around(std::span<const PointChunk> chunks, const Eigen::Matrix3d& R_WV,
                            const Intrinsics& intrinsics, const ViewConfig& config) {
  constexpr double kOutliers = 0.0002;
  const std::vector<Eigen::Vector3d> points_W = sample(chunks, R_WV.col(2));
  if (points_W.empty()) {
    VirtualCamera camera{intrinsics, Pose::Identity()};
    camera.X_WV.linear() = R_WV;
    return camera;
  }
  return fit_points(points_W, kOutliers, R_WV, intrinsics, config.margin_px);
}

std::optional<VirtualCamera> close_up(std::span<const PointChunk> chunks, const Highlight& segments,
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

VirtualCamera camera_for(const View& view, const Scene& scene, const FollowedCamera& followed,
                         int width, int height, const ViewConfig& config) {
  const Intrinsics intrinsics = pinhole(width, height, config.field_of_view_rad);
  if (const auto* fixed = std::get_if<FixedView>(&view)) {
    return {intrinsics, look_at(fixed->eye_W, fixed->target_W, scene.up().up_W())};
  }
  if (std::holds_alternative<FollowView>(view) && followed.has_pose()) {
    return follow(scene, followed, intrinsics, config);
  }
  return overview(scene, intrinsics, config);
}

}  // namespace kintsugi::viewer
