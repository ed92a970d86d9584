#include "mapper/source/frames/source_config.hpp"

#include <cmath>

#include "lcmtypes/base/argument_check.hpp"
#include "mapper/source/frames/device_mode.hpp"

namespace kintsugi::mapper {
namespace {

void check_positive(const char* field, double value) {
  require(std::isfinite(value) && value > 0.0, field, value, "a finite number greater than 0");
}

void check_not_negative(const char* field, double value) {
  require(std::isfinite(value) && value >= 0.0, field, value, "a finite number, 0 or greater");
}

}  // namespace

void SourceConfig::validate() const {
  check_positive("max_range_m", max_range_m);
  check_not_negative("lcm_silence_s", lcm_silence_s);
  if (!depth_mode.empty()) DeviceMode::parse("depth_mode", depth_mode);
  if (!color_mode.empty()) DeviceMode::parse("color_mode", color_mode);
  check_not_negative("lock_exposure_after_s", lock_exposure_after_s.value_or(0.0));
  check_positive("device_silence_s", device_silence_s);
  check_not_negative("reconnect_s", reconnect_s);
  require(notify != nullptr, "notify is empty, must be a function");
  require(stop_requested != nullptr, "stop_requested is empty, must be a function");
}

}  // namespace kintsugi::mapper
