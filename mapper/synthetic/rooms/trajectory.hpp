#pragma once
// The path of a hand-held camera: smooth, within speed limits, with a little shake.

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "lcmtypes/geometry.hpp"

namespace kintsugi::synthetic {

/// The pose X_WC of a camera at position_W that looks at target_W, with the top of the image
/// towards z of W.
/// @throws std::invalid_argument if the two coincide or the viewing direction is vertical
Pose look_at(const Eigen::Vector3d& position_W, const Eigen::Vector3d& target_W);

struct Waypoint {
  Eigen::Vector3d position_W;  ///< metres
  Eigen::Vector3d target_W;    ///< metres; the point that the camera looks at
};

inline constexpr int kFrameRate_hz = 30;  ///< of frame_utime() and Trajectory::num_frames()

/// Time of frame i at 30 Hz, microseconds, rounded to the nearest.
std::int64_t frame_utime(std::int64_t frame_index);

/// Position and target follow cubic splines through the waypoints. The camera moves more slowly
/// where it turns, and in total for `duration_s`. The shake of the hand is a band-limited (0.3
/// to 2.5 Hz) sum of sines that is added to position and orientation.
class Trajectory {
 public:
  struct Config {
    double duration_s = 10.0;              ///< > 0
    double turn_m_per_rad = 0.35;          ///< a turn takes as long as moving this far, >= 0
    double shake_position_m = 0.002;       ///< amplitude of each of the sines, >= 0
    double shake_orientation_rad = 0.003;  ///< amplitude of each of the sines, >= 0
    std::uint32_t seed = 1;                ///< for the shake

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };

  /// @throws std::invalid_argument with fewer than two waypoints, or when look_at() throws
  Trajectory(const std::vector<Waypoint>& waypoints, const Config& config);

  /// Pose of the camera C in the scene's frame W; t_s is clamped to [0, laps * duration_s]. Each
  /// lap is along the same path; the shake goes on.
  Pose X_WC(double t_s, int laps = 1) const;

  /// Whether the path ends where it begins, so that there can be several laps.
  bool is_closed() const;

  double duration_s() const { return config_.duration_s; }
  /// Of the path without the shake, metres.
  double length_m() const { return length_m_; }
  /// Number of frames at 30 Hz; the first is at time 0, the last not after the end.
  int num_frames() const;

 private:
  struct Knot {  // of the dense table that X_WC interpolates
    double t_s;
    Eigen::Vector3d position_W;
    Eigen::Quaterniond q_WC;
  };
  struct Sine {
    double amplitude;
    double rad_per_s;
    double phase_rad;
  };
  static constexpr int kSinesPerAxis = 4;

  void sample_splines(const std::vector<Waypoint>& waypoints);
  void assign_times();
  double shake(int axis, double t_s) const;

  Config config_;
  std::vector<Knot> knots_;
  std::vector<Sine> sines_;  // kSinesPerAxis for each of x y z, then for each rotation
  double length_m_ = 0.0;
};

}  // namespace kintsugi::synthetic
