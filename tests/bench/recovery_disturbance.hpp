#pragma once
// Disturbances of a recording: which frames to play, when, and how they are damaged.

#include <cstdint>
#include <string>
#include <vector>

#include "mapper/core/frame/rgbd_frame.hpp"

namespace kintsugi::mapper::bench {

enum class Damage {
  kNone,
  kWiped,   ///< no depth and a black image, as with a hand on the lens
  kCutOff,  ///< three quarters of the width empty, on one side
};

struct PlannedFrame {
  int frame = 0;           ///< index in the recording
  std::int64_t utime = 0;  ///< time of the frame, later than that of the frame before, us
  Damage damage = Damage::kNone;
  bool operator==(const PlannedFrame&) const = default;
};

using Plan = std::vector<PlannedFrame>;

/// "none", "every-2", "every-3", "every-5", "every-10", "gap-1s", "gap-5s", "wiped", "cut-off",
/// "covered", "covered-back", "jump".
const std::vector<std::string>& disturbance_names();

/// Plans how a recording of `num_frames` frames, `period_us` apart, is played with a disturbance:
///   none          unchanged
///   every-N       every Nth frame
///   gap-Ns        a gap of N seconds after every three seconds
///   wiped         a random fifth of the frames is empty (never the first ten)
///   cut-off       the same frames are empty in three quarters of their width
///   covered       after two fifths all frames are empty for 3 s, while the recording continues
///   covered-back  the even frames of the first half, then 3 s of empty frames, then the odd frames
///                 from a quarter on: the camera was moved back meanwhile
///   jump          the even frames of the first three quarters, then without a gap in time the odd
///                 frames from a tenth on: known places, seen from slightly other poses
/// The same name, number and seed give the same plan.
/// @throws std::invalid_argument for an unknown name; the message lists the known ones
Plan plan_disturbance(const std::string& name, int num_frames, std::int64_t period_us,
                      std::uint32_t seed = 1);

/// The frame with its planned time and damage.
RgbdFrame spoil(RgbdFrame frame, const PlannedFrame& planned);

}  // namespace kintsugi::mapper::bench
