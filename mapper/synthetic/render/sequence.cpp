#include "mapper/synthetic/render/sequence.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "lcmtypes/base/argument_check.hpp"

namespace kintsugi::synthetic {

namespace {

/// Of which a frame of 30 Hz is each.
constexpr std::array kRates_hz = {30, 15, 10, 6, 5, 3, 2, 1};

}  // namespace

Sequence::Sequence(const Config& config)
    : config_(config),
      content_(make_scene_with_path(config.scene, config.seed)),
      sensor_(make_sensor({.name = config.sensor, .noise = config.noise, .seed = config.seed})),
      intrinsics_(sensor_->intrinsics()) {
  check_range("synthetic: speed", config_.speed, 0.1, 10.0);
  check_range("synthetic: laps", config_.laps, 1, 1000);
  require(config_.laps == 1 || content_.trajectory.is_closed(), "synthetic: laps", config_.laps,
          "1: the path does not end where it begins");
  require(std::ranges::find(kRates_hz, config_.rate_hz) != kRates_hz.end(), "synthetic: rate",
          config_.rate_hz, "30, 15, 10, 6, 5, 3, 2 or 1");
  const int on_path = frames_on_path();
  check_range("synthetic: start", config_.start, 0, on_path - 1);
  num_frames_ = config_.frames.value_or(on_path - config_.start);
  check_range("synthetic: frames", num_frames_, 1, on_path - config_.start);
  check_range("synthetic: covered", config_.covered.second, config_.covered.first, num_frames_);
  check_range("synthetic: covered", config_.covered.first, 0, num_frames_);
  if (changes_between_laps(config_.scene)) {
    content_.scene = make_scene_in_lap(config_.scene, config_.seed, lap_of(num_frames_ - 1));
  }
}

int Sequence::frames_on_path() const {
  const double duration_s = config_.laps * content_.trajectory.duration_s() / config_.speed;
  return 1 + static_cast<int>(std::floor(duration_s * config_.rate_hz + 1e-9));
}

void Sequence::check_index(int frame) const {
  if (frame < 0 || frame >= num_frames_) {
    throw std::out_of_range("synthetic: frame " + std::to_string(frame) + ", expected 0 to " +
                            std::to_string(num_frames_ - 1));
  }
}

Pose Sequence::X_WC(int frame) const {
  check_index(frame);
  // The path is sampled at the time of its own 30 Hz, to the microsecond as utime(): at twice the
  // speed frame i is where frame 2 i is otherwise, exactly.
  const double path_frames = config_.speed * kFrameRate_hz / config_.rate_hz;
  const double path_us =
      std::floor(path_frames * (config_.start + frame) * 1e6 / kFrameRate_hz + 0.5);
  return content_.trajectory.X_WC(1e-6 * path_us, config_.laps);
}

int Sequence::lap_of(int frame) const {
  const double path_s = config_.speed * (config_.start + frame) / config_.rate_hz;
  return std::min(static_cast<int>(path_s / content_.trajectory.duration_s() + 1e-9),
                  config_.laps - 1);
}

const Scene& Sequence::scene_at(int frame) {
  if (!changes_between_laps(config_.scene)) return content_.scene;
  if (const int lap = lap_of(frame); lap != lap_) {
    in_lap_ = make_scene_in_lap(config_.scene, config_.seed, lap);
    lap_ = lap;
  }
  return *in_lap_;
}

const RenderedFrame& Sequence::truth(int frame) {
  if (frame != rendered_) {
    last_ = render(scene_at(frame), intrinsics_, X_WC(frame));
    rendered_ = frame;
  }
  return last_;
}

bool Sequence::is_covered(int frame) const {
  return frame >= config_.covered.first && frame < config_.covered.second;
}

cv::Mat Sequence::color_rgb(int frame) {
  if (!is_covered(frame)) return truth(frame).color_rgb.clone();
  return cv::Mat3b(intrinsics_.height, intrinsics_.width, cv::Vec3b());
}

cv::Mat_<std::uint16_t> Sequence::depth_mm(int frame) {
  if (is_covered(frame)) {
    return cv::Mat_<std::uint16_t>(intrinsics_.height, intrinsics_.width, std::uint16_t{0});
  }
  return sensor_->apply(truth(frame), config_.start + frame);
}

}  // namespace kintsugi::synthetic
