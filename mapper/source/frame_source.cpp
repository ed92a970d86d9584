#include "mapper/source/frame_source.hpp"

#include <cmath>
#include <stdexcept>

#include "mapper/source/bus/lcm_source.hpp"
#include "mapper/source/openni2/device_mode.hpp"
#include "mapper/source/openni2/openni2_source.hpp"

namespace kintsugi::mapper {

void SourceConfig::validate() const {
  if (!(std::isfinite(max_range_m) && max_range_m > 0.0)) {
    throw std::invalid_argument("max_range_m is " + std::to_string(max_range_m) +
                                ", expected a finite number greater than 0");
  }
  if (!(std::isfinite(lcm_silence_s) && lcm_silence_s >= 0.0)) {
    throw std::invalid_argument("lcm_silence_s is " + std::to_string(lcm_silence_s) +
                                ", expected a finite number, 0 or greater");
  }
  if (!depth_mode.empty()) DeviceMode::parse("depth_mode", depth_mode);
  if (!color_mode.empty()) DeviceMode::parse("color_mode", color_mode);
  if (lock_exposure_after_s &&
      !(std::isfinite(*lock_exposure_after_s) && *lock_exposure_after_s >= 0.0)) {
    throw std::invalid_argument("lock_exposure_after_s is " +
                                std::to_string(*lock_exposure_after_s) +
                                ", expected a finite number, 0 or greater");
  }
  if (!(std::isfinite(device_silence_s) && device_silence_s > 0.0)) {
    throw std::invalid_argument("device_silence_s is " + std::to_string(device_silence_s) +
                                ", expected a finite number greater than 0");
  }
  if (!(std::isfinite(reconnect_s) && reconnect_s >= 0.0)) {
    throw std::invalid_argument("reconnect_s is " + std::to_string(reconnect_s) +
                                ", expected a finite number, 0 or greater");
  }
  if (!notify) throw std::invalid_argument("notify is empty, expected a function");
  if (!stop_requested) throw std::invalid_argument("stop_requested is empty, expected a function");
}

std::unique_ptr<FrameSource> open_frame_source(const SourceConfig& config) {
  config.validate();
  if (config.device.starts_with(kLcmScheme)) return std::make_unique<LcmSource>(config);
  return std::make_unique<OpenNi2Source>(config);
}

}  // namespace kintsugi::mapper
