// The noise of depth on the command line.

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/core/frame/sensors.hpp"
#include "tests/mapper/process/parsed_options.hpp"

namespace kintsugi::mapper {
namespace {

using testing::error_of;
using ::testing::HasSubstr;
using testing::options_of;
using testing::parse;
using testing::TemporaryFile;

void expect_noise(const std::optional<DepthNoise>& noise, const DepthNoise& expected) {
  ASSERT_TRUE(noise);
  EXPECT_EQ(noise->base_m, expected.base_m);
  EXPECT_EQ(noise->share, expected.share);
  EXPECT_EQ(noise->growth_per_m, expected.growth_per_m);
}

TEST(NoiseOptions, LeaveTheSensorToTheImageAndTheNoiseToTheResiduals) {
  const Options options = options_of({});
  EXPECT_FALSE(options.pipeline.noise);
  EXPECT_TRUE(options.pipeline.learn_noise);
}

TEST(NoiseOptions, ASensorIsWhereLearningStarts) {
  for (const char* name : {"structured-light", "stereo", "phone-lidar"}) {
    const Options options = options_of({"--sensor", name});
    expect_noise(options.pipeline.noise, noise_of_sensor(name).value());
    EXPECT_TRUE(options.pipeline.learn_noise) << name;
  }
}

TEST(NoiseOptions, AnUnknownSensorIsNamedWithTheKnownOnes) {
  for (const std::string name : {"kinect", "Stereo", "stereo,"}) {
    EXPECT_EQ(error_of({"--sensor", name.c_str()}),
              "--sensor is '" + name + "', must be structured-light, stereo or phone-lidar");
  }
}

TEST(NoiseOptions, AGivenNoiseIsNotLearned) {
  for (const char* text : {"0.002,0.01,0.003", "2e-3,1e-2,3e-3", "0.002, 0.01, 0.003"}) {
    const Options options = options_of({"--depth-noise", text});
    expect_noise(options.pipeline.noise, {.base_m = 0.002, .share = 0.01, .growth_per_m = 0.003});
    EXPECT_FALSE(options.pipeline.learn_noise) << text;
  }
  expect_noise(options_of({"--depth-noise", "1,1,1", "--max-range", "4"}).pipeline.noise,
               {.base_m = 1.0, .share = 1.0, .growth_per_m = 1.0});
  expect_noise(options_of({"--depth-noise", "0.001,0,0"}).pipeline.noise,
               {.base_m = 0.001, .share = 0.0, .growth_per_m = 0.0});
}

TEST(NoiseOptions, ABadNoiseIsNamedWithWhatIsExpected) {
  const std::vector<std::string> bad = {"0.002",               // one of three
                                        "0.002,0.01",          // two
                                        "0.002,0.01,0.003,0",  // four
                                        "0.002;0.01;0.003",    // not commas
                                        "0.002,,0.003",        // an empty one
                                        "0.002,0.01,x",        // no number
                                        "0.002,0.01,0.003 m",  // a unit
                                        "nan,0.01,0.003",      // not finite
                                        "0.002,inf,0.003",     //
                                        "0,0.01,0.003",        // a camera without any noise near by
                                        "-0.002,0.01,0.003",   // out of bounds, each
                                        "0.002,-0.01,0.003",   //
                                        "0.002,0.01,-0.003",   //
                                        "1.5,0.01,0.003",      //
                                        "0.002,1.5,0.003",     //
                                        "0.002,0.01,1.5"};     //
  for (const std::string& text : bad) {
    EXPECT_THAT(error_of({"--depth-noise", text.c_str()}),
                HasSubstr("--depth-noise is '" + text + "', expected BASE,SHARE,GROWTH"));
  }
}

TEST(NoiseOptions, ExcludeEachOther) {
  EXPECT_EQ(error_of({"--sensor", "stereo", "--depth-noise", "0.002,0.01,0.003"}),
            "--sensor and --depth-noise exclude each other");
}

TEST(NoiseOptions, MustMatchWhenASessionIsResumed) {
  EXPECT_EQ(mapping_options(options_of({"--sensor", "stereo"})).at("--sensor"), "stereo");
  EXPECT_EQ(mapping_options(options_of({"--depth-noise", "0.002,0.01,0.003"})).at("--depth-noise"),
            "0.002,0.01,0.003");
}

TEST(NoiseOptions, WhatIsPrintedCanBeReadBack) {
  ::testing::internal::CaptureStdout();
  EXPECT_EQ(std::get<int>(parse({"--depth-noise", "0.002,0.01,0.003", "--print-config"})), 0);
  const TemporaryFile file(::testing::internal::GetCapturedStdout());
  expect_noise(options_of({"--config", file.path().c_str()}).pipeline.noise,
               {.base_m = 0.002, .share = 0.01, .growth_per_m = 0.003});
}

TEST(NoiseOptions, ANoisySensorIsUsedLessFar) {
  EXPECT_LT(options_of({"--sensor", "stereo"}).source.max_range_m,
            options_of({"--sensor", "structured-light"}).source.max_range_m);
}

}  // namespace
}  // namespace kintsugi::mapper
