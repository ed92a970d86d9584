#pragma once
// What a camera records in a synthetic scene, frame by frame.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <opencv2/core.hpp>

#include "mapper/synthetic/render/renderer.hpp"
#include "mapper/synthetic/rooms/scenes.hpp"
#include "mapper/synthetic/sensors/sensors.hpp"

namespace kintsugi::synthetic {

/// Depth, colour and ground truth of a scene along its path, with the image size and the geometry
/// of the depth sensor. Frames can be rendered in any order with the same result; the one rendered
/// last is kept.
class Sequence {
 public:
  struct Config {
    std::string scene = "office";    ///< one of scene_names()
    std::string sensor = "kinect1";  ///< one of sensor_names()
    bool noise = true;               ///< of the depth sensor
    double speed = 1.0;              ///< times that of the path, within [0.1, 10]
    int laps = 1;                    ///< how often the path is walked, if it is closed
    int rate_hz = 30;                ///< frames per second, 30, 15, 10, 6, 5, 3, 2 or 1
    std::uint32_t seed = 1;          ///< for the noise of the sensor and the shake of the hand
    int start = 0;                   ///< first frame, >= 0 and on the path
    std::optional<int> frames;       ///< how many, >= 1 and on the path; absent: to the path's end
    /// Meanwhile something is in front of the camera: black, without depth. From the first of these
    /// frames to the one before the second.
    std::pair<int, int> covered = {0, 0};
    std::string ground_truth;  ///< folder for write_ground_truth(); empty: none

    /// From the options of a `synthetic://scene?key=value&...` address, as known_options() lists
    /// them.
    /// @throws std::invalid_argument naming a bad key or value, and what is allowed
    static Config parse(const std::string& scene,
                        const std::map<std::string, std::string>& options);

    /// "sensor=kinect1|... noise=on|off ...", for people.
    static std::string known_options();
  };

  /// @throws std::invalid_argument naming scene or field, value and bound
  explicit Sequence(const Config& config);

  const Config& config() const { return config_; }
  /// As it is at the last frame. Things of a scene that changes were elsewhere in earlier laps.
  const Scene& scene() const { return content_.scene; }
  const Intrinsics& intrinsics() const { return intrinsics_; }
  int num_frames() const { return num_frames_; }

  /// Time since the start of the path, microseconds; frame 0 is at frame `start` of the path.
  std::int64_t utime(int frame) const {
    return frame_utime(std::int64_t{kFrameRate_hz / config_.rate_hz} * (config_.start + frame));
  }

  /// Which time the path is walked at this frame, from 0.
  int lap_of(int frame) const;

  /// True pose in the scene's frame (see Scene).
  Pose X_WC(int frame) const;

  const RenderedFrame& truth(int frame);  ///< valid until the next call

  /// As the sensor sees it, millimetres, 0 is invalid.
  cv::Mat_<std::uint16_t> depth_mm(int frame);
  /// As the camera sees it: true, but where it is covered.
  cv::Mat color_rgb(int frame);

 private:
  int frames_on_path() const;
  void check_index(int frame) const;
  const Scene& scene_at(int frame);
  bool is_covered(int frame) const;

  Config config_;
  SceneWithPath content_;
  std::optional<Scene> in_lap_;  ///< of a scene that changes: as it is in lap_
  int lap_ = -1;
  std::unique_ptr<SensorModel> sensor_;
  Intrinsics intrinsics_;
  int num_frames_ = 0;
  int rendered_ = -1;
  RenderedFrame last_;
};

}  // namespace kintsugi::synthetic
