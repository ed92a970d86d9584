#pragma once

#include <functional>
#include <optional>
#include <string>

namespace kintsugi::mapper {

/// A message for the person at the camera, sent while the source runs.
struct SourceNotice {
  enum class Kind {
    kInformation,
    kWarning,      ///< the source works, but not as well as it could
    kInterrupted,  ///< the camera was disconnected; next() waits for it
    kResumed,      ///< the camera is connected again
  };
  Kind kind = Kind::kInformation;
  std::string text;  ///< a sentence
};

/// How to open a source.
struct SourceConfig {
  /// Empty: the first camera. Otherwise the path of a .oni file, `folder://PATH`,
  /// `synthetic://NAME?key=value`, `lcm://CHANNEL`, or the URI of a camera as OpenNI2 lists it.
  std::string device;
  /// Intrinsics and distortion (camera.txt, of which depth_scale is not used); empty: what the
  /// device knows about itself, or a camera.txt beside an .oni file.
  std::string calibration_file;
  double max_range_m = 6.5;  ///< depth beyond it is invalid, metres, > 0

  // Only for `lcm://CHANNEL`.
  std::string lcm_url;  ///< the bus; empty: LCM's default
  /// Frames wait in memory, compressed, until next() is called. Otherwise only the newest waits.
  bool replay = false;
  /// The source ends when no frame has come for this time after the first one, seconds, >= 0;
  /// 0: never.
  double lcm_silence_s = 10.0;

  // Only for cameras.
  /// `WIDTHxHEIGHT`, `WIDTHxHEIGHT@HZ`, or empty: 640x480@30 where offered, else the nearest.
  std::string depth_mode;
  /// As above; empty: as depth where offered, else the nearest that covers the depth image.
  std::string color_mode;
  /// Use colour although the device neither aligns it with depth nor says that it is aligned
  /// (a .oni file does not say so). Otherwise such colour is not used.
  bool assume_registered = false;
  /// Time after the first image at which exposure and white balance are locked, seconds, >= 0;
  /// absent: never.
  std::optional<double> lock_exposure_after_s;
  /// A camera that has sent no depth image for this time counts as disconnected, seconds, > 0.
  double device_silence_s = 5.0;
  /// How long to wait for a disconnected camera, seconds, >= 0; 0: without limit.
  double reconnect_s = 0.0;

  /// Called from the threads that open the source and call next().
  std::function<void(const SourceNotice&)> notify = [](const SourceNotice&) {};
  /// Called at least ten times a second while next() waits; true ends the source.
  std::function<bool()> stop_requested = [] { return false; };

  /// @throws std::invalid_argument naming the field, its value and its bound
  void validate() const;
};

}  // namespace kintsugi::mapper
