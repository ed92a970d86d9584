#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace kintsugi::mapper {

/// What a device of ours can imitate of real cameras: what they offer, refuse and do to their user.
/// Given as options of the device's address; all off, it is a recording that plays.
struct CameraImitation {
  struct Mode {
    int width = 0;
    int height = 0;
    int rate_hz = 0;
  };
  enum class DepthFormat : std::uint8_t { k1mm, k100um, kShift };
  enum class Registration : std::uint8_t {
    kAligned,     ///< depth and colour see the same, and the device says so
    kSwitchable,  ///< only once it has been switched on
    kOff,         ///< never
  };
  enum class Mirroring : std::uint8_t { kOff, kOn, kStuck };  ///< at first; stuck: for good

  bool camera = false;                   ///< live and without an end, in contrast to a file
  bool depth = true;                     ///< there is a depth stream
  bool color = true;                     ///< there is a colour stream, if the recording has one
  bool calibration = true;               ///< the device tells more than its field of view
  std::vector<Mode> depth_modes;         ///< empty: the recording's own
  std::vector<Mode> color_modes;         ///< empty: the recording's own
  std::vector<DepthFormat> depth_units;  ///< empty: those that suit the recording
  bool refuse_modes = false;             ///< what is offered cannot be set
  Registration registration = Registration::kAligned;
  Mirroring mirror = Mirroring::kOff;
  bool exposure = false;  ///< there are camera settings, automatic at first

  double color_drop = 0.0;          ///< share of the colour images that never come, 0 to 1
  int color_gap_first = 0;          ///< colour images from this to the next never come, from 1
  int color_gap_last = 0;           ///< 0: no gap
  std::int64_t color_delay_us = 0;  ///< they come so much after the depth image of their time
  std::int64_t color_clock_us = 0;  ///< their times are so far ahead of the depth images'
  int clock_jump_at = 0;            ///< from this depth image on, from 1; 0: never
  std::int64_t clock_jump_us = 0;   ///< ... times are by this ahead
  int empty_every = 0;              ///< every so manieth depth image has no pixels; 0: none
  int misfit_every = 0;             ///< ... or is smaller than its mode

  int unplug_at = 0;  ///< goes away after so many depth images; 0: stays
  /// Comes back so long afterwards, as far ahead in the recording; absent: never.
  std::optional<std::int64_t> replug_after_us;
  bool unplug_silently = false;  ///< nobody is told: images just stop coming
  bool restart_clock = false;    ///< counts its time from 0 when it is back
  bool new_port = false;         ///< comes back under another address: with port=1
  int port = 0;                  ///< makes an address another one, nothing else
  std::string serial_number;     ///< empty: it has none

  /// Takes the options that are of this kind out of `options`.
  /// @throws std::invalid_argument naming option, value and what was expected.
  static CameraImitation take_from(std::map<std::string, std::string>& options);

  /// Every option with its values, for messages.
  static std::string known_options();
};

}  // namespace kintsugi::mapper
