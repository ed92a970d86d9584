#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "mapper/core/frame/rgbd_frame.hpp"

namespace kintsugi::mapper {

/// What became of the images that a source was given.
struct SourceCounts {
  std::int64_t frames_delivered = 0;  ///< handed out by next()
  std::int64_t frames_dropped = 0;    ///< superseded by a newer one before they were asked for
  std::int64_t depth_unpaired = 0;    ///< delivered without colour: none within half a frame
  std::int64_t color_unpaired = 0;    ///< colour images without a depth image
  std::int64_t frames_bad = 0;        ///< refused: undecodable or of another size
  std::int64_t interruptions = 0;     ///< the camera went away (whether or not it came back)
  double convert_ms = 0.0;            ///< time spent on metres and undistortion
};

/// Something that a person at the camera should know, said while the source runs.
struct SourceNotice {
  enum class Kind {
    kInformation,
    kWarning,      ///< works, but not as well as it could
    kInterrupted,  ///< the camera is gone; next() waits for it
    kResumed,      ///< and is back
  };
  Kind kind = Kind::kInformation;
  std::string text;  ///< a sentence
};

/// Where RGB-D frames come from: undistorted, un-mirrored, in metres, colour paired by time.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  /// The next frame, waiting for it; nullopt at the end (end_reason() says which end), and on every
  /// call after that. Called from one thread. Times ascend strictly, whatever the device's clock
  /// does; over an interruption they go on by the time that passed.
  virtual std::optional<RgbdFrame> next() = 0;

  /// Of the whole recording, by depth images; -1 when not known (a live camera).
  [[nodiscard]] virtual std::int64_t frames_total() const = 0;

  /// The device's own name, for people.
  [[nodiscard]] virtual std::string name() const = 0;

  [[nodiscard]] virtual SourceCounts counts() const = 0;

  /// Why next() returned nullopt, as a sentence; empty before that.
  [[nodiscard]] virtual std::string end_reason() const = 0;

  /// False when the recording ended before its announced length or the device failed: the frames
  /// delivered are good, the run should say so.
  [[nodiscard]] virtual bool ended_well() const = 0;
};

/// How to open a source.
struct SourceConfig {
  /// Empty: the first camera. Otherwise the path of a .oni file, `folder://PATH`,
  /// `synthetic://NAME?key=value`, `lcm://CHANNEL`, or the URI of a camera as OpenNI2 lists it.
  std::string device;
  /// Intrinsics and distortion (camera.txt); empty: what the device knows about itself, or a
  /// camera.txt beside the recording.
  std::string calibration_file;
  /// Every frame of a recording, as fast as it is asked for. Otherwise a recording plays at its own
  /// speed and, like a live camera, loses its oldest waiting frame when next() is late.
  bool replay = false;
  double max_range_m = 6.5;  ///< depth beyond it is invalid, metres, > 0
  std::string lcm_url;       ///< bus of `lcm://CHANNEL`; empty: LCM's default
  /// `lcm://CHANNEL` ends when nothing has come for so long after its first frame, seconds, >= 0;
  /// 0: never.
  double lcm_silence_s = 10.0;

  // Cameras.
  /// `WIDTHxHEIGHT`, `WIDTHxHEIGHT@HZ`, or empty: 640x480@30 where offered, else the nearest.
  std::string depth_mode;
  /// As above; empty: as depth where offered, else the nearest that covers the depth image.
  std::string color_mode;
  /// Colour is aligned with depth although the device neither aligns them nor says that they are
  /// (a .oni file does not tell). Otherwise such colour is not used.
  bool assume_registered = false;
  /// Exposure and white balance stay as they are so long after the first image, seconds, >= 0;
  /// absent: they go on adapting.
  std::optional<double> lock_exposure_after_s;
  double device_silence_s = 5.0;  ///< a camera without depth images for so long is gone, > 0
  /// How long to wait for a camera that is gone, seconds, >= 0; 0: as long as it takes.
  double reconnect_s = 0.0;
  /// Called from the threads that open the source and call next().
  std::function<void(const SourceNotice&)> notify = [](const SourceNotice&) {};

  /// Asked at least ten times a second while next() waits; true ends the source.
  std::function<bool()> stop_requested = [] { return false; };

  /// @throws std::invalid_argument naming the field, its value and its bound.
  void validate() const;
};

/// Opens the source that `config.device` names.
/// @throws std::invalid_argument for a bad configuration, std::runtime_error with the file or
/// device and the reason when it cannot be opened or is empty.
std::unique_ptr<FrameSource> open_frame_source(const SourceConfig& config);

}  // namespace kintsugi::mapper
