#include "mapper/synthetic/sensors/sensors.hpp"

#include <functional>
#include <map>
#include <stdexcept>

#include "mapper/synthetic/sensors/clean_sensor.hpp"
#include "mapper/synthetic/sensors/phone_lidar.hpp"
#include "mapper/synthetic/sensors/stereo.hpp"
#include "mapper/synthetic/sensors/structured_light.hpp"
#include "mapper/synthetic/sensors/time_of_flight.hpp"

namespace kintsugi::synthetic {

namespace {

using Maker = std::function<std::unique_ptr<SensorModel>(std::uint32_t seed)>;

template <typename Sensor>
std::unique_ptr<SensorModel> make(std::uint32_t seed) {
  typename Sensor::Config config;
  config.seed = seed;
  return std::make_unique<Sensor>(config);
}

const std::map<std::string, Maker>& makers() {
  static const std::map<std::string, Maker> kMakers = {
      {"kinect1", make<StructuredLight>},
      {"kinect2", make<TimeOfFlight>},
      {"d435", make<Stereo>},
      {"lidar", make<PhoneLidar>},
      {"clean", [](std::uint32_t) { return std::make_unique<CleanSensor>(CleanSensor::Config{}); }},
  };
  return kMakers;
}

}  // namespace

const std::vector<std::string>& sensor_names() {
  static const std::vector<std::string> kNames = [] {
    std::vector<std::string> names;
    for (const auto& [name, maker] : makers()) names.push_back(name);
    return names;
  }();
  return kNames;
}

std::unique_ptr<SensorModel> make_sensor(const SensorConfig& config) {
  const auto maker = makers().find(config.name);
  if (maker == makers().end()) {
    std::string message = "no synthetic sensor \"" + config.name + "\"; there are:";
    for (const std::string& known : sensor_names()) message += " " + known;
    throw std::invalid_argument(message);
  }
  std::unique_ptr<SensorModel> sensor = maker->second(config.seed);
  if (config.noise) return sensor;
  return std::make_unique<CleanSensor>(
      CleanSensor::Config{.intrinsics = sensor->intrinsics(), .range = sensor->range()});
}

}  // namespace kintsugi::synthetic
