// Flags that the programs of the segmenter share.

#include <fstream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <gmock/gmock.h>

#include "segmenter/core/presets.hpp"
#include "segmenter/process/options.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::HasSubstr;

class SegmentationOptions : public ::testing::Test {
 protected:
  void SetUp() override {
    add_segmentation_options(app_, config_);
    app_.set_config("--config");
  }
  const EngineConfig& parse(std::vector<std::string> arguments) {
    std::reverse(arguments.begin(), arguments.end());  // CLI11 takes them from the back
    app_.parse(arguments);
    return config_.engine;
  }
  std::string config_file(const std::string& text) const {
    std::ofstream(folder_ / "config.toml") << text;
    return (folder_ / "config.toml").string();
  }

  CLI::App app_;
  SegmentMapConfig config_;
  kintsugi::testing::TemporaryFolder folder_;
};

void expect_parameters(const EngineConfig& engine, const EngineConfig& expected) {
  EXPECT_EQ(engine.threshold, expected.threshold);
  EXPECT_EQ(engine.scale, expected.scale);
  EXPECT_EQ(engine.color_weight, expected.color_weight);
  EXPECT_EQ(engine.min_points, expected.min_points);
  EXPECT_EQ(engine.radius_factor, expected.radius_factor);
}

TEST_F(SegmentationOptions, AreThoseOfObjectsByDefault) {
  expect_parameters(parse({}), preset("objects"));
}

TEST_F(SegmentationOptions, OfThePaperAreThoseOfAnEngineConfig) {
  expect_parameters(parse({"--preset", "paper"}), EngineConfig());
}

TEST_F(SegmentationOptions, CanStartFromAnotherPreset) {
  CLI::App app;
  SegmentMapConfig config;
  add_segmentation_options(app, config, "paper");
  app.parse(std::vector<std::string>{});
  expect_parameters(config.engine, EngineConfig());
}

TEST_F(SegmentationOptions, OfAPresetGiveWayToValuesOnEitherSideOfIt) {
  EngineConfig expected = preset("paper");
  expected.scale = 0.1;
  expected.min_points = 7.0;
  expect_parameters(parse({"--scale", "0.1", "--preset", "paper", "--min-points", "7"}), expected);
}

TEST_F(SegmentationOptions, InAFileGiveWayToTheCommandLineAndToItsOwnPresetNever) {
  const std::string file = config_file("scale=0.1\ncolor-weight=0.5\npreset=\"objects\"\n");
  EngineConfig expected = preset("paper");
  expected.scale = 0.1;
  expected.color_weight = 0.25;
  expect_parameters(parse({"--preset", "paper", "--config", file, "--color-weight", "0.25"}),
                    expected);
}

TEST_F(SegmentationOptions, KeepOtherValuesWhateverThePreset) {
  const EngineConfig& engine =
      parse({"--audit", "--beta", "0.5", "--neighbours", "flann", "--preset", "paper"});
  EXPECT_TRUE(engine.audit);
  EXPECT_EQ(engine.beta, 0.5);
  EXPECT_EQ(engine.neighbour_search, NeighbourSearch::kFlann);
}

TEST_F(SegmentationOptions, ArePrintedAsTheyAreAndReadBack) {
  parse({"--preset", "paper", "--min-points", "20"});
  const std::string printed = app_.config_to_str(true);
  EXPECT_THAT(printed, HasSubstr("preset=\"paper\""));
  EXPECT_THAT(printed, HasSubstr("scale=0.0005"));
  CLI::App app;
  SegmentMapConfig config;
  add_segmentation_options(app, config);
  app.set_config("--config");
  app.parse("--config " + config_file(printed));
  expect_parameters(config.engine, config_.engine);
}

TEST_F(SegmentationOptions, RefuseAnUnknownPresetAndNameThoseThereAre) {
  try {
    parse({"--preset", "desks"});
    FAIL() << "was taken";
  } catch (const CLI::ParseError& error) {
    EXPECT_THAT(error.what(), HasSubstr("objects"));
    EXPECT_THAT(error.what(), HasSubstr("paper"));
  }
}

}  // namespace
}  // namespace kintsugi::segmenter
