#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/openni2_driver/recording/camera_imitation.hpp"
#include "mapper/openni2_driver/recording/recording_uri.hpp"
#include "tests/mapper/openni2_driver/recording_folder.hpp"

namespace kintsugi::mapper {
namespace {

using test::error_of;
using testing::AllOf;
using testing::HasSubstr;
using testing::Key;

TEST(CameraImitation, TakesItsOptionsAndLeavesTheOthers) {
  std::map<std::string, std::string> options = {{"camera", "on"},
                                                {"depth_modes", "640x480@30,320x240@60"},
                                                {"depth_units", "100um"},
                                                {"registration", "switchable"},
                                                {"mirror", "stuck"},
                                                {"color_delay_ms", "12.5"},
                                                {"color_gap", "3-7"},
                                                {"replug_after_ms", "500"},
                                                {"seed", "7"}};
  const auto imitation = CameraImitation::take_from(options);
  EXPECT_THAT(options, testing::ElementsAre(Key("seed")));
  EXPECT_TRUE(imitation.camera);
  ASSERT_EQ(imitation.depth_modes.size(), 2U);
  EXPECT_EQ(imitation.depth_modes[1].width, 320);
  EXPECT_EQ(imitation.depth_modes[1].rate_hz, 60);
  EXPECT_THAT(imitation.depth_units, testing::ElementsAre(CameraImitation::DepthFormat::k100um));
  EXPECT_EQ(imitation.registration, CameraImitation::Registration::kSwitchable);
  EXPECT_EQ(imitation.mirror, CameraImitation::Mirroring::kStuck);
  EXPECT_EQ(imitation.color_delay_us, 12500);
  EXPECT_EQ(imitation.color_gap_first, 3);
  EXPECT_EQ(imitation.color_gap_last, 7);
  EXPECT_EQ(imitation.replug_after_us, 500000);
}

TEST(CameraImitation, RefusesBadValuesByName) {
  const std::vector<std::pair<std::string, std::string>> bad = {
      {"camera", "1"},          {"depth_modes", "640x480"},  {"depth_modes", "640x480@30,"},
      {"color_modes", "9x9@0"}, {"depth_units", "1mm,2mm"},  {"registration", "on"},
      {"mirror", ""},           {"color_drop", "1.1"},       {"color_drop", "nan"},
      {"color_gap", "7-3"},     {"color_gap", "7"},          {"color_delay_ms", "-1"},
      {"clock_jump_at", "0"},   {"clock_jump_ms", "1e10"},   {"empty_every", "2.5"},
      {"unplug_at", "-3"},      {"replug_after_ms", "soon"},
  };
  for (const auto& [name, value] : bad) {
    std::map<std::string, std::string> options = {{name, value}};
    const auto message =
        error_of<std::invalid_argument>([&] { CameraImitation::take_from(options); });
    EXPECT_THAT(message, AllOf(HasSubstr("option " + name + " is '"),
                               HasSubstr("is '" + value + "', expected ")));
  }
}

TEST(CameraImitation, IsListedWhereAnOptionIsUnknown) {
  const auto folder =
      error_of<std::invalid_argument>([] { parse_recording_uri("folder:///data?unplugat=3"); });
  EXPECT_THAT(folder, AllOf(HasSubstr("no option 'unplugat'"), HasSubstr("unplug_at=N")));
  const auto scene = error_of<std::invalid_argument>(
      [] { open_recording(*parse_recording_uri("synthetic://office?unplugat=3")); });
  EXPECT_THAT(scene, AllOf(HasSubstr("no option 'unplugat'"), HasSubstr("seed=N"),
                           HasSubstr("unplug_at=N")));
}

}  // namespace
}  // namespace kintsugi::mapper
