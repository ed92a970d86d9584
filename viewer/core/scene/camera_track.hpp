#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi::viewer {

/// Where the depth camera was and is, as a picture shows it.
struct CameraTrack {
  std::vector<Eigen::Vector3f> path_W;  ///< in order of device time, metres
  std::optional<Pose> X_WC;             ///< at the newest of these times; nothing: not known
};

/// A pose at its device time.
struct TimedPose {
  std::int64_t utime = 0;
  Pose X_WC = Pose::Identity();
};

/// The poses that were heard. Each comes once and nobody sends it again, so there may be gaps; what
/// is known of those times otherwise, the poses that came with the slices, stands in.
class HeardPoses {
 public:
  /// False when it says nothing about where the camera is: lost, starting, or not newer than the
  /// one before.
  bool add(const CameraPose& pose);

  /// What was heard, with those of `known` (in order of time) in the gaps.
  CameraTrack track(const std::vector<TimedPose>& known) const;

  std::int64_t memory_bytes() const;

 private:
  static constexpr double kStep_m = 0.02;                ///< between two points of the path
  static constexpr std::int64_t kMaxPause_us = 250'000;  ///< a longer one is a gap

  struct Position {
    std::int64_t utime = 0;
    Eigen::Vector3f position_W;
  };
  struct Interval {
    std::int64_t first_utime = 0;
    std::int64_t last_utime = 0;
  };

  bool heard_at(std::int64_t utime) const;

  std::vector<Position> positions_;  // ascending in time
  std::vector<Interval> heard_;      // without a gap each; ascending
  std::optional<TimedPose> newest_;
};

/// The track through `known` (in order of time) alone: what everyone who has the map knows.
CameraTrack track_through(const std::vector<TimedPose>& known);

}  // namespace kintsugi::viewer
