#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/source/frames/device_mode.hpp"
#include "tests/mapper/openni2_driver/recording_folder.hpp"

namespace kintsugi::mapper {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::vector<DeviceMode> kXtion = {{320, 240, 30}, {320, 240, 60},   {640, 480, 30},
                                        {640, 480, 25}, {1280, 1024, 15}, {160, 120, 30}};

TEST(DeviceMode, ReadsSizeAndRate) {
  EXPECT_EQ(DeviceMode::parse("mode", "640x480@30"), (DeviceMode{640, 480, 30}));
  EXPECT_EQ(DeviceMode::parse("mode", "1280x1024"), (DeviceMode{1280, 1024, 0}));
  EXPECT_EQ(to_string(DeviceMode{1280, 1024, 15}), "1280x1024@15");
}

TEST(DeviceMode, RefusesEverythingElseByName) {
  for (const char* text : {"", "640", "640x", "x480", "640x480@", "640x480@0", "0x480", "-640x480",
                           "640x480@30 ", "640X480", "640x480@30Hz", "99999x480", "640x480x30"}) {
    EXPECT_THAT(test::error_of<std::invalid_argument>([&] { DeviceMode::parse("mode", text); }),
                AllOf(HasSubstr("mode is '" + std::string(text) + "'"), HasSubstr("640x480@30")));
  }
}

TEST(DeviceMode, PrefersTheSizeAndThenTheRate) {
  EXPECT_EQ(nearest_mode(kXtion, {640, 480, 30}), 2U);
  EXPECT_EQ(nearest_mode(kXtion, {640, 480, 60}), 2U) << "30 is nearer to 60 than 25 is";
  EXPECT_EQ(nearest_mode(kXtion, {330, 250, 50}), 1U);
  EXPECT_EQ(nearest_mode({}, {640, 480, 30}), std::nullopt);
}

TEST(DeviceMode, FindsOnlyWhatIsOffered) {
  EXPECT_EQ(find_mode(kXtion, {320, 240, 60}), 1U);
  EXPECT_EQ(find_mode(kXtion, {320, 240, 0}), 0U) << "nearest to 30 Hz";
  EXPECT_EQ(find_mode(kXtion, {1280, 1024, 0}), 4U);
  EXPECT_EQ(find_mode(kXtion, {1280, 1024, 30}), std::nullopt);
  EXPECT_EQ(find_mode(kXtion, {800, 600, 0}), std::nullopt);
}

TEST(DeviceMode, ListsEachModeOnce) {
  const std::vector<DeviceMode> twice = {{320, 240, 30}, {640, 480, 30}, {320, 240, 30}};
  EXPECT_EQ(list_of(twice), "640x480@30 320x240@30");
  EXPECT_EQ(list_of({}), "none");
}

TEST(RegisteredPart, IsTheTopOfATallerColourImage) {
  EXPECT_EQ(registered_part({1280, 1024}, {640, 480}), cv::Rect(0, 0, 1280, 960));
  EXPECT_EQ(registered_part({640, 480}, {640, 480}), cv::Rect(0, 0, 640, 480));
  EXPECT_EQ(registered_part({320, 240}, {640, 480}), cv::Rect(0, 0, 320, 240));
  EXPECT_EQ(registered_part({1280, 1024}, {1280, 1024}), cv::Rect(0, 0, 1280, 1024));
  EXPECT_EQ(registered_part({1280, 720}, {640, 480}), std::nullopt) << "depth sees more";
  EXPECT_EQ(registered_part({640, 480}, {1280, 1024}), std::nullopt);
}

}  // namespace
}  // namespace kintsugi::mapper
