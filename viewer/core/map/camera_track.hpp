#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi::viewer {

/// Path and last pose of the depth camera and the loops on its path, as a picture shows them.
struct CameraTrack {
  std::vector<Eigen::Vector3f> path_W;  ///< positions in order of device time, metres
  std::optional<Pose> X_WC;             ///< newest pose; nothing: no pose is known
  std::vector<LoopLink> loops = {};
};

/// A pose at its device time.
struct TimedPose {
  std::int64_t utime = 0;
  Pose X_WC = Pose::Identity();
};

/// The camera poses received. A lost pose is not sent again, so there may be gaps in time; poses
/// known from elsewhere, those that came with slices, fill them.
class ReceivedPoses {
 public:
  /// False when the pose is not used: camera lost or starting, or not newer than the last pose.
  bool add(const CameraPose& pose);

  /// Device time of the newest pose; nothing: there is none.
  std::optional<std::int64_t> newest_utime() const {
    return newest_ ? std::optional(newest_->utime) : std::nullopt;
  }

  /// The poses received, with those of `known` (in order of time) that fall into gaps.
  CameraTrack track(const std::vector<TimedPose>& known) const;

 private:
  static constexpr double kStep_m = 0.02;                   ///< between two points of the path
  static constexpr std::int64_t kMaxInterval_us = 250'000;  ///< between two poses without a gap

  struct Position {
    std::int64_t utime = 0;
    Eigen::Vector3f position_W;
  };
  struct Interval {
    std::int64_t first_utime = 0;
    std::int64_t last_utime = 0;
  };

  bool covers(std::int64_t utime) const;

  std::vector<Position> positions_;  // ascending in time
  std::vector<Interval> intervals_;  // without gaps; ascending
  std::optional<TimedPose> newest_;
};

/// The track through `known` (in order of time) alone.
CameraTrack track_through(const std::vector<TimedPose>& known);

}  // namespace kintsugi::viewer
