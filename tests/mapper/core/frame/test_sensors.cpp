#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/core/frame/sensors.hpp"

namespace kintsugi::mapper {
namespace {

Intrinsics camera_of(int width, int height) {
  return {.fx = 500, .fy = 500, .cx = 100, .cy = 100, .width = width, .height = height};
}

TEST(Sensors, AreKnownByTheNamesInTheMessage) {
  for (const std::string name : {"structured-light", "stereo", "phone-lidar"}) {
    EXPECT_TRUE(noise_of_sensor(name)) << name;
    EXPECT_THAT(std::string(kSensorNames), ::testing::HasSubstr(name));
  }
  for (const std::string name : {"", "Stereo", "stereo ", "kinect"}) {
    EXPECT_FALSE(noise_of_sensor(name)) << name;
  }
}

TEST(Sensors, DifferInHowTheirNoiseGrows) {
  // Of twice the depth: four times for triangulation, twice for interpolated points.
  const auto growth = [](const std::string& name) {
    const DepthNoise noise = noise_of_sensor(name).value();
    return noise.sigma_m(8.0) / noise.sigma_m(4.0);
  };
  EXPECT_NEAR(growth("structured-light"), 4.0, 0.05);
  EXPECT_NEAR(growth("stereo"), 4.0, 0.05);
  EXPECT_NEAR(growth("phone-lidar"), 2.0, 0.05);
}

TEST(Sensors, StereoHasTheDisparityErrorOfItsBaseline) {
  // 0.08 pixels at 615 pixels and 50 mm.
  EXPECT_NEAR(noise_of_sensor("stereo")->sigma_m(4.0), 16.0 * 0.08 / (615.0 * 0.05), 5e-4);
}

TEST(TypicalNoise, IsThatOfAPhoneForItsImageAndOfStructuredLightForOthers) {
  const double phone_m = noise_of_sensor("phone-lidar")->sigma_m(1.0);
  const double structured_light_m = noise_of_sensor("structured-light")->sigma_m(1.0);
  EXPECT_EQ(typical_noise(camera_of(256, 192)).sigma_m(1.0), phone_m);
  for (const auto& [width, height] : {std::pair{640, 480}, {320, 240}, {192, 256}, {256, 190}}) {
    EXPECT_EQ(typical_noise(camera_of(width, height)).sigma_m(1.0), structured_light_m);
  }
}

}  // namespace
}  // namespace kintsugi::mapper
