#pragma once
// The depth sensors by name.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "mapper/synthetic/sensors/sensor_model.hpp"

namespace kintsugi::synthetic {

/// "kinect1" (StructuredLight), "kinect2" (TimeOfFlight), "d435" (Stereo), "lidar" (PhoneLidar) and
/// "clean" (CleanSensor), in alphabetical order.
const std::vector<std::string>& sensor_names();

struct SensorConfig {
  std::string name = "kinect1";  ///< one of sensor_names()
  bool noise = true;             ///< off: a CleanSensor with the geometry and range of this one
  std::uint32_t seed = 1;
};

/// @throws std::invalid_argument naming the known sensors, if `name` is none of them
std::unique_ptr<SensorModel> make_sensor(const SensorConfig& config);

}  // namespace kintsugi::synthetic
