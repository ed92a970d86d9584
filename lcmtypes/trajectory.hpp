#pragma once
// Camera trajectories, and the TUM text format for them.

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lcmtypes/geometry.hpp"

namespace kintsugi {

/// The pose of the camera at one time.
struct StampedPose {
  std::int64_t utime = 0;  ///< microseconds
  Pose X_WC = Pose::Identity();
};

/// Poses in strictly increasing order of time.
using Trajectory = std::vector<StampedPose>;

/// A pose is used for times at most this far from its own.
inline constexpr std::int64_t kMaxPoseDistance_us = 20'000;

/// The pose at `utime`. If there is a pose within kMaxPoseDistance_us on both sides, it is
/// interpolated: the translation linearly, the rotation by spherical linear interpolation. If there
/// is one on one side only, it is that pose; else nothing.
std::optional<Pose> pose_at(const Trajectory& trajectory, std::int64_t utime);

/// Reads lines `timestamp tx ty tz qx qy qz qw` (seconds, metres; '#' starts a comment). The
/// timestamp is read exactly, to the microsecond. The length of a quaternion may differ from 1 by 1
/// %, as with few decimals; it is normalised.
/// @param name of the file, for errors
/// @throws std::runtime_error "NAME:LINE: what is wrong" for a wrong number of fields, a field that
/// is
///   not a finite number, a position beyond 1e9 m, a quaternion not of unit length, or a time not
///   after that of the pose before; and "NAME: what is wrong" if there is no pose at all
Trajectory read_tum(std::istream& in, const std::string& name);

/// Writes the format that read_tum() reads: the time exactly, metres and quaternion to 1e-9.
void write_tum(std::ostream& out, const Trajectory& trajectory);

/// Converts seconds as text to microseconds: "12.034567" to 12034567, rounded to nearest if there
/// are more than six decimals. Nothing if it is not a plain decimal number within +-4e12 s.
std::optional<std::int64_t> parse_seconds_us(std::string_view text);

/// Reads a file in the format of read_tum().
/// @throws std::runtime_error as read_tum(), and when the file cannot be opened
Trajectory read_tum_file(const std::string& file);

/// The angle of the rotation, in [0, pi].
double rotation_angle_rad(const Pose& X_AB);

}  // namespace kintsugi
