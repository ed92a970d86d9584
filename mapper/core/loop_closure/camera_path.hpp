#pragma once
// The camera's path, which follows when the keyframes on it are moved.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <vector>

#include "lcmtypes/trajectory.hpp"
#include "mapper/core/loop_closure/map_deformation.hpp"

namespace kintsugi::mapper {

/// The poses of the camera as tracked, in the uncorrected map (U) and, for each, the keyframe that
/// it was at. A pose takes 48 bytes.
class CameraPath {
 public:
  /// Adds the pose at a time after all before. `jumped`: it was not tracked from the one before.
  void add(std::int64_t utime, const Pose& X_UC, int keyframe, bool jumped);

  /// Length, without jumps, metres.
  double length_m() const { return length_m_; }

  /// The path in the corrected map, by part of the map. Between the moment when the camera came to
  /// a keyframe and the one when it came to the next, the correction goes over linearly from that
  /// of the one to that of the other, unless it jumped.
  std::map<int, Trajectory> corrected(const MapDeformation& deformation) const;

 private:
  struct Step {
    Step(std::int64_t time, const Pose& X_UC);
    Pose X_UC() const;

    std::int64_t utime;
    Eigen::Vector3d t_UC;
    Eigen::Quaternionf q_UC;  ///< rounded: by 1e-7 rad
  };
  /// While the camera was at one keyframe.
  struct Stay {
    int keyframe;
    std::size_t first;  ///< of steps_
    bool jumped;
  };

  std::deque<Step> steps_;
  std::vector<Stay> stays_;
  double length_m_ = 0.0;
};

}  // namespace kintsugi::mapper
