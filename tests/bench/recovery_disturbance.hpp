#pragma once
// What may go wrong with a sequence of frames, as a plan of which frames to play and how to spoil
// them.

#include <cstdint>
#include <string>
#include <vector>

#include "mapper/core/frame/rgbd_frame.hpp"

namespace kintsugi::mapper::bench {

enum class Damage {
  kNone,
  kWiped,   ///< no depth at all, a black picture: a hand on the lens
  kCutOff,  ///< three quarters of the width wiped, on one side
};

struct PlannedFrame {
  int frame = 0;           ///< of the recording
  std::int64_t utime = 0;  ///< when it is played: always later than the one before
  Damage damage = Damage::kNone;
  bool operator==(const PlannedFrame&) const = default;
};

using Plan = std::vector<PlannedFrame>;

/// "none", "every-2", "every-3", "every-5", "every-10", "gap-1s", "gap-5s", "wiped", "cut-off",
/// "covered", "covered-back", "jump".
const std::vector<std::string>& disturbance_names();

/// How a recording of so many frames, `period_us` apart, is played under a disturbance:
///   none          as it is
///   every-N       every Nth frame
///   gap-Ns        again and again three seconds and then a gap
///   wiped         a random fifth of the frames wiped (never the first ten)
///   cut-off       the same frames with three quarters of their width wiped
///   covered       all wiped for 3 s after two fifths; the recording goes on meanwhile
///   covered-back  the even frames of the first half, then 3 s of wiped ones, then the odd frames
///                 from a quarter on: the camera was carried back
///   jump          the even frames of three quarters, then without any gap in time the odd frames
///                 from a tenth on: places seen long before, never from these poses exactly
/// The same name, number and seed give the same plan.
/// @throws std::invalid_argument for another name, naming those there are
Plan plan_disturbance(const std::string& name, int num_frames, std::int64_t period_us,
                      std::uint32_t seed = 1);

/// The frame as it is played.
RgbdFrame spoil(RgbdFrame frame, const PlannedFrame& planned);

}  // namespace kintsugi::mapper::bench
