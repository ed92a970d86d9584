#include "mapper/synthetic/render/sequence.hpp"

#include <charconv>
#include <limits>
#include <stdexcept>

#include "lcmtypes/base/argument_check.hpp"

namespace kintsugi::synthetic {

namespace {

template <typename Integer>
Integer parse_integer(const std::string& key, const std::string& value) {
  Integer number{};
  const char* end = value.data() + value.size();
  const auto [stopped, error] = std::from_chars(value.data(), end, number);
  if (error != std::errc() || stopped != end) {
    throw std::invalid_argument("synthetic: option " + key + " is '" + value +
                                "', expected a whole number up to " +
                                std::to_string(std::numeric_limits<Integer>::max()));
  }
  return number;
}

bool parse_switch(const std::string& key, const std::string& value) {
  if (value == "on") return true;
  if (value == "off") return false;
  throw std::invalid_argument("synthetic: option " + key + " is '" + value +
                              "', expected on or off");
}

}  // namespace

Sequence::Config Sequence::Config::parse(const std::string& scene,
                                         const std::map<std::string, std::string>& options) {
  Config config;
  config.scene = scene;
  for (const auto& [key, value] : options) {
    if (key == "noise") {
      config.noise = parse_switch(key, value);
    } else if (key == "seed") {
      config.seed = parse_integer<std::uint32_t>(key, value);
    } else if (key == "start") {
      config.start = parse_integer<int>(key, value);
    } else if (key == "frames") {
      config.frames = parse_integer<int>(key, value);
    } else if (key == "ground_truth") {
      config.ground_truth = value;
    } else {
      throw std::invalid_argument("synthetic: no option '" + key +
                                  "'; there are: noise=on|off seed=N start=N frames=N "
                                  "ground_truth=FOLDER");
    }
  }
  return config;
}

Sequence::Sequence(const Config& config)
    : config_(config),
      content_(make_scene_with_path(config.scene, config.seed)),
      sensor_({.noise = config.noise, .seed = config.seed}) {
  const int on_path = content_.trajectory.num_frames();
  check_range("synthetic: start", config_.start, 0, on_path - 1);
  num_frames_ = config_.frames.value_or(on_path - config_.start);
  check_range("synthetic: frames", num_frames_, 1, on_path - config_.start);
}

void Sequence::check_index(int frame) const {
  if (frame < 0 || frame >= num_frames_) {
    throw std::out_of_range("synthetic: frame " + std::to_string(frame) + ", expected 0 to " +
                            std::to_string(num_frames_ - 1));
  }
}

Pose Sequence::X_WC(int frame) const {
  check_index(frame);
  return content_.trajectory.X_WC(1e-6 * static_cast<double>(utime(frame)));
}

const RenderedFrame& Sequence::truth(int frame) {
  if (frame != rendered_) {
    last_ = render(content_.scene, intrinsics_, X_WC(frame));
    rendered_ = frame;
  }
  return last_;
}

cv::Mat_<std::uint16_t> Sequence::depth_mm(int frame) {
  return sensor_.apply(truth(frame), config_.start + frame);
}

}  // namespace kintsugi::synthetic
