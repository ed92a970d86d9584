#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace kintsugi::mapper {

/// Properties and faults of real cameras that a device of our driver can imitate. They are options
/// in the address of the device; without any, the device is a recording.
struct CameraImitation {
  struct Mode {
    int width = 0;
    int height = 0;
    int rate_hz = 0;
  };
  enum class DepthFormat : std::uint8_t { k1mm, k100um, kShift };
  enum class Registration : std::uint8_t {
    kAligned,     ///< depth and colour are aligned, and the device says so
    kSwitchable,  ///< aligned after registration has been switched on
    kOff,         ///< never aligned
  };
  enum class Mirroring : std::uint8_t {
    kOff,
    kOn,
    kStuck
  };  ///< initially; kStuck: cannot be changed

  bool camera = false;            ///< a live device without an end; otherwise a file
  bool depth = true;              ///< there is a depth stream
  bool color = true;              ///< there is a colour stream, if the recording has one
  bool calibration = true;        ///< the device provides intrinsics, not only its field of view
  std::vector<Mode> depth_modes;  ///< empty: the recording's own
  std::vector<Mode> color_modes;  ///< empty: the recording's own
  std::vector<DepthFormat> depth_units;  ///< empty: those that suit the recording
  bool refuse_modes = false;             ///< the modes on offer cannot be set
  Registration registration = Registration::kAligned;
  Mirroring mirror = Mirroring::kOff;
  bool exposure = false;  ///< there are camera settings, initially automatic

  double color_drop = 0.0;          ///< fraction of colour images that are missing, 0 to 1
  int color_gap_first = 0;          ///< first of a range of missing colour images, from 1
  int color_gap_last = 0;           ///< last of them; 0: no gap
  std::int64_t color_delay_us = 0;  ///< delay relative to the depth image of the same time
  std::int64_t color_clock_us = 0;  ///< offset of their time stamps, relative to depth images
  int clock_jump_at = 0;            ///< number of a depth image, from 1; 0: never
  std::int64_t clock_jump_us = 0;   ///< offset of time stamps from that image on
  int empty_every = 0;              ///< every n-th depth image has no pixels; 0: none
  int misfit_every = 0;             ///< every n-th depth image is smaller than its mode; 0: none

  int unplug_at = 0;  ///< number of depth images before it is disconnected; 0: never
  /// Time after which it comes back, at that later point of the recording; absent: never.
  std::optional<std::int64_t> replug_after_us;
  bool unplug_silently = false;  ///< no event when it is disconnected: images stop
  bool restart_clock = false;    ///< time stamps start from 0 when it is back
  bool new_port = false;         ///< comes back under another address, with port=1
  int port = 0;                  ///< only distinguishes addresses
  std::string serial_number;     ///< empty: none

  /// Reads the options of this kind and removes them from `options`.
  /// @throws std::invalid_argument naming option, value and what was expected
  static CameraImitation take_from(std::map<std::string, std::string>& options);

  /// Every option with its values, for messages.
  static std::string known_options();
};

}  // namespace kintsugi::mapper
