#pragma once
// Camera paths over time, and the TUM text format for them.

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lcmtypes/geometry.hpp"

namespace kintsugi {

struct StampedPose {
  std::int64_t utime = 0;  ///< microseconds
  Pose X_WC = Pose::Identity();
};

/// Poses in strictly increasing order of time.
using Trajectory = std::vector<StampedPose>;

/// A pose counts for a moment at most this far from it.
inline constexpr std::int64_t kMaxPoseDistance_us = 20'000;

/// The pose at `utime`: interpolated (translation linearly, rotation on the great circle) when
/// there is a pose within 20 ms on either side, else the only near one, else nothing.
std::optional<Pose> pose_at(const Trajectory& trajectory, std::int64_t utime);

/// Reads lines `timestamp tx ty tz qx qy qz qw` (seconds, metres; '#' starts a comment). The
/// timestamp is read as a decimal number, exact to the microsecond. A quaternion may be off unit
/// length by 1 % (few decimals) and is normalised.
/// @param name of the file, for messages
/// @throws std::runtime_error "NAME:LINE: what is wrong" on a wrong number of fields, a field that
///   is no finite number, a position beyond 1e9 m, a quaternion not of unit length, a time not
///   after the one before it; and "NAME: ..." when there is no pose at all
Trajectory read_tum(std::istream& in, const std::string& name);

/// Writes the format that read_tum reads: microseconds exactly, metres and quaternion to 1e-9.
void write_tum(std::ostream& out, const Trajectory& trajectory);

/// "12.034567" as 12034567; digits beyond the sixth decimal round to nearest. Nothing if it is not
/// a plain decimal number within +-4e12 s.
std::optional<std::int64_t> parse_seconds_us(std::string_view text);

/// Reads the file of that name. @throws as read_tum(), and with the reason if it cannot be opened
Trajectory read_tum_file(const std::string& file);

/// By how much the pose turns, in [0, pi].
double rotation_angle_rad(const Pose& X_AB);

}  // namespace kintsugi
