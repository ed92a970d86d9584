#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>

#include "viewer/core/rendering/highlight.hpp"
#include "viewer/core/rendering/virtual_camera.hpp"
#include "viewer/core/scene/scene.hpp"

namespace kintsugi::viewer {

/// Behind and above the camera, along its heading: the camera and the map about it.
struct FollowView {};
/// The whole map from outside and above; walls and ceilings that face away are left out.
struct OverviewView {};
/// From `eye_W` towards `target_W`, metres.
struct FixedView {
  Eigen::Vector3d eye_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d target_W = Eigen::Vector3d::UnitZ();
};
using View = std::variant<FollowView, OverviewView, FixedView>;

/// "follow", "overview" or "x,y,z,lookx,looky,lookz" in metres, W.
/// Throws std::invalid_argument that quotes the text and says what was expected.
View parse_view(const std::string& text);

/// Where the camera is and where it heads, without the shaking of the hand that holds it.
class FollowedCamera {
 public:
  /// Position and horizontal heading go through a low-pass filter in map time. A pose that is not
  /// newer than the last one is passed over.
  void update(const CameraPose& pose, const Eigen::Vector3d& up_W);

  bool has_pose() const { return utime_ > 0; }
  const Eigen::Vector3d& position_W() const { return position_W_; }
  const Eigen::Vector3d& heading_W() const { return heading_W_; }  ///< unit

 private:
  std::int64_t utime_ = 0;
  Eigen::Vector3d position_W_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d heading_W_ = Eigen::Vector3d::UnitZ();
};

struct ViewConfig {
  double field_of_view_rad = 0.9;
  double follow_radius_m = 5.0;   ///< the map so far from the camera is fitted into the picture
  double follow_pitch_rad = 0.6;  ///< below the horizon
  double overview_yaw_rad = 0.5;  ///< turned from the first camera's forward direction
  double overview_pitch_rad = 0.8;
  double margin_px = 24.0;  ///< left free around what is fitted into a picture

  /// Throws std::invalid_argument naming the field, its value and the bound.
  void validate() const;
};

/// The camera with this orientation that fits the points that face it, but for a few, into the
/// picture; without any, at W's origin.
VirtualCamera camera_around(std::span<const PointChunk> chunks, const Eigen::Matrix3d& R_WV,
                            const Intrinsics& intrinsics, const ViewConfig& config);

/// The camera with this orientation that fits the points of these segments into the picture, with
/// what is about them. Nothing when there are no such points.
std::optional<VirtualCamera> close_up(std::span<const PointChunk> chunks, const Highlight& segments,
                                      const Eigen::Matrix3d& R_WV, const Intrinsics& intrinsics);

/// The camera that a view asks for; the overview where there is no pose to follow yet.
VirtualCamera camera_for(const View& view, const Scene& scene, const FollowedCamera& followed,
                         int width, int height, const ViewConfig& config);

}  // namespace kintsugi::viewer
