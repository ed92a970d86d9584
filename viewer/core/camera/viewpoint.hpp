#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <variant>

#include "viewer/core/camera/smoothed_camera.hpp"
#include "viewer/core/camera/virtual_camera.hpp"
#include "viewer/core/map/received_map.hpp"

namespace kintsugi::viewer {

/// Behind and above the depth camera, looking along its heading at the map around it.
struct FollowViewpoint {};
/// The whole map from outside and above. Points that face away are not drawn: one looks through
/// ceilings and near walls.
struct OverviewViewpoint {};
/// From `eye_W` towards `target_W`, metres.
struct FixedViewpoint {
  Eigen::Vector3d eye_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d target_W = Eigen::Vector3d::UnitZ();
};
/// How the virtual camera is chosen.
using Viewpoint = std::variant<FollowViewpoint, OverviewViewpoint, FixedViewpoint>;

/// Reads "follow", "overview" or "x,y,z,lookx,looky,lookz" (eye and target, metres, W).
/// @throws std::invalid_argument that quotes the text and names what was expected
Viewpoint parse_viewpoint(const std::string& text);

struct ViewpointConfig {
  double field_of_view_rad = 0.9;  ///< along the longer side of the picture
  double follow_radius_m = 5.0;    ///< the map within this distance of the camera is in the picture
  double follow_pitch_rad = 0.6;   ///< below the horizon
  double overview_yaw_rad = 0.5;   ///< to the left of W's z, the first camera's viewing direction
  double overview_pitch_rad = 0.8;  ///< below the horizon
  double margin_px = 24.0;          ///< between the points and the edge of the picture

  /// @throws std::invalid_argument naming the field, its value and the bound
  void validate() const;
};

/// The camera with this orientation in whose picture the points of these segments fit, with some of
/// their surroundings. Nothing when no point has one of these labels.
std::optional<VirtualCamera> close_up(std::span<const PointChunk> chunks,
                                      const std::set<std::uint32_t>& segments,
                                      const Eigen::Matrix3d& R_WV, const Intrinsics& intrinsics);

/// The virtual camera at a viewpoint of one part of the map; the overview instead of following a
/// camera without a pose. A few outliers of the map may lie beside the picture, and at a fixed
/// viewpoint anything; but not `all_of_these_W`, metres: the frustum of the depth camera.
VirtualCamera camera_at(const Viewpoint& viewpoint, const ReceivedMap& map, std::int32_t part,
                        const SmoothedCamera& depth_camera, int width_px, int height_px,
                        const ViewpointConfig& config,
                        std::span<const Eigen::Vector3d> all_of_these_W = {});

}  // namespace kintsugi::viewer
