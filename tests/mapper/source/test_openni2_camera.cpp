// Cameras as the driver imitates them, through the system's own OpenNI2.

#include <cmath>
#include <set>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/source/open_source.hpp"
#include "tests/mapper/openni2_driver/recording_folder.hpp"

namespace kintsugi::mapper {
namespace {

using test::error_of;
using test::RecordingFolder;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Kind = SourceNotice::Kind;

constexpr int kManyFrames = 40;
constexpr const char* kCamera = "50 51 31.5 23.5 64 48 1000\n";

class Camera : public testing::Test {
 protected:
  /// Opens the recording as the options make it, every frame of it.
  FrameSource& open(const std::string& options) {
    config_.device = folder_.uri() + options;
    config_.notify = [this](const SourceNotice& notice) { notices_.push_back(notice); };
    source_ = open_frame_source(config_);
    return *source_;
  }
  std::vector<RgbdFrame> read(std::size_t most = 1000) {
    std::vector<RgbdFrame> frames;
    while (frames.size() < most) {
      auto frame = source_->next();
      if (!frame) break;
      frames.push_back(std::move(*frame));
    }
    return frames;
  }
  std::vector<RgbdFrame> read_as(const std::string& options) {
    open(options);
    return read();
  }
  std::string refusal(const std::string& options) {
    return error_of<std::runtime_error>([&] { open(options); });
  }
  std::vector<Kind> kinds() const {
    std::vector<Kind> kinds;
    for (const auto& notice : notices_) kinds.push_back(notice.kind);
    return kinds;
  }

  RecordingFolder folder_{kCamera, kManyFrames};
  SourceConfig config_;
  std::vector<SourceNotice> notices_;
  std::unique_ptr<FrameSource> source_;
};

bool has_color_of(const RgbdFrame& frame, int index) {
  return !frame.color_rgb.empty() &&
         cv::norm(frame.color_rgb, test::color_image(index), cv::NORM_INF) == 0.0;
}

/// The frame has the depth of the recording's, mirrored by nobody.
void expect_depth_of(const RgbdFrame& frame, int index) {
  EXPECT_NEAR(frame.depth_m(5, 9), 0.001F * static_cast<float>(test::raw_depth(index, 9, 5)),
              1e-6F);
  EXPECT_NEAR(frame.depth_m(7, 50), 0.001F * static_cast<float>(test::raw_depth(index, 50, 7)),
              1e-6F);
}

void expect_ascending(const std::vector<RgbdFrame>& frames) {
  for (std::size_t i = 1; i < frames.size(); ++i) {
    EXPECT_GT(frames[i].utime, frames[i - 1].utime) << i;
    EXPECT_GT(frames[i].frame_index, frames[i - 1].frame_index) << i;
  }
}

TEST_F(Camera, GivesDepthInEitherUnit) {
  for (const char* unit : {"1mm", "100um"}) {
    const auto frames = read_as(std::string("?depth_units=") + unit);
    ASSERT_EQ(frames.size(), kManyFrames) << unit;
    expect_depth_of(frames[3], 3);
  }
}

TEST_F(Camera, PrefersTheFineUnitWithinItsReach) {
  config_.max_range_m = 6.0;
  EXPECT_FALSE(std::isnan(read_as("?depth_units=1mm,100um")[0].depth_m(5, 9)));
  config_.max_range_m = 8.0;  // 100 um end at 6.55 m
  expect_depth_of(read_as("?depth_units=1mm,100um")[10], 10);
}

TEST_F(Camera, ThatGivesRawDisparitiesIsRefused) {
  EXPECT_THAT(refusal("?depth_units=shift"),
              AllOf(HasSubstr("raw disparities"), HasSubstr("expected units of 1 mm or 0.1 mm")));
}

TEST_F(Camera, WithoutDepthIsRefused) {
  EXPECT_THAT(refusal("?depth=off"), HasSubstr("has no depth stream"));
}

TEST_F(Camera, WithoutColourGivesDepthAlone) {
  const auto frames = read_as("?color=off");
  ASSERT_EQ(frames.size(), kManyFrames);
  EXPECT_TRUE(frames[0].color_rgb.empty());
  EXPECT_THAT(notices_, IsEmpty());
}

TEST_F(Camera, IsRegisteredWhereItCanBe) {
  const auto frames = read_as("?registration=switchable");
  ASSERT_EQ(frames.size(), kManyFrames);
  expect_depth_of(frames[2], 2);
  EXPECT_TRUE(has_color_of(frames[2], 2));
  EXPECT_THAT(notices_, IsEmpty());
}

TEST_F(Camera, ThatCannotBeRegisteredGivesDepthAloneAndSaysSo) {
  const auto frames = read_as("?registration=off");
  ASSERT_EQ(frames.size(), kManyFrames);
  for (const auto& frame : frames) EXPECT_TRUE(frame.color_rgb.empty());
  EXPECT_THAT(kinds(), ElementsAre(Kind::kWarning));
  EXPECT_THAT(notices_[0].text, AllOf(HasSubstr("depth alone"), HasSubstr("--assume-registered")));
  config_.assume_registered = true;
  EXPECT_TRUE(has_color_of(read_as("?registration=off")[2], 2));
}

TEST_F(Camera, ToldByItsFieldOfViewAlone) {
  const auto frame = (open("?calibration=off"), read(1)).at(0);
  EXPECT_NEAR(frame.intrinsics.fx, 50.0, 1e-4);  // the angle is a float
  EXPECT_NEAR(frame.intrinsics.fy, 51.0, 1e-4);
  EXPECT_EQ(frame.intrinsics.cx, 32.0);
}

TEST_F(Camera, IsUnmirrored) {
  for (const char* mirror : {"on", "stuck"}) {
    const auto frames = read_as(std::string("?mirror=") + mirror);
    ASSERT_EQ(frames.size(), kManyFrames) << mirror;
    expect_depth_of(frames[1], 1);
    EXPECT_TRUE(has_color_of(frames[1], 1)) << mirror;
  }
}

TEST_F(Camera, OfAnyResolutionIsCalibratedForIt) {
  config_.depth_mode = "32x24";
  const auto frames = read_as("?depth_modes=64x48@30,32x24@30,128x96@30");
  ASSERT_EQ(frames.size(), kManyFrames);
  EXPECT_EQ(frames[0].depth_m.size(), cv::Size(32, 24));
  EXPECT_EQ(frames[0].color_rgb.size(), cv::Size(32, 24)) << "scaled onto depth";
  EXPECT_EQ(frames[0].intrinsics.fx, 25.0);
  EXPECT_EQ(frames[0].depth_m(2, 4), 0.001F * static_cast<float>(test::raw_depth(0, 8, 4)));
}

TEST_F(Camera, WithTallerColourHasTheRowsBelowCutOff) {
  const auto frames = read_as("?color_modes=128x102@30");  // as 1280x1024 is to 640x480
  ASSERT_EQ(frames.size(), kManyFrames);
  const cv::Mat color = frames[4].color_rgb;
  ASSERT_EQ(color.size(), cv::Size(64, 48));
  EXPECT_LE(cv::norm(color, test::color_image(4), cv::NORM_INF), 1.0) << "resampled twice";
}

TEST_F(Camera, WithColourThatDoesNotCoverDepthGivesDepthAlone) {
  const auto frames = read_as("?color_modes=128x72@30");
  ASSERT_EQ(frames.size(), kManyFrames);
  EXPECT_TRUE(frames[0].color_rgb.empty());
  ASSERT_THAT(kinds(), ElementsAre(Kind::kWarning));
  EXPECT_THAT(notices_[0].text, HasSubstr("does not cover"));
}

TEST_F(Camera, TakesVgaAt30HzByDefault) {
  config_.depth_mode.clear();
  open(
      "?camera=on&depth_modes=320x240@60,160x120@30,640x480@60,640x480@30&color_modes=320x240@30,"
      "640x480@30");
  const auto frames = read(1);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].depth_m.size(), cv::Size(640, 480));
  EXPECT_EQ(frames[0].intrinsics.fx, 500.0);
}

TEST_F(Camera, ListsItsModesWhenAskedForAnother) {
  config_.depth_mode = "640x480@30";
  EXPECT_THAT(refusal("?depth_modes=64x48@30,32x24@60"),
              AllOf(HasSubstr("depth_mode is '640x480@30'"), HasSubstr("64x48@30 32x24@60")));
  config_.depth_mode.clear();
  config_.color_mode = "1280x1024";
  EXPECT_THAT(refusal("?color_modes=64x48@30"),
              AllOf(HasSubstr("color_mode is '1280x1024'"), HasSubstr("offers: 64x48@30")));
  config_.color_mode = "fine";
  EXPECT_THAT(error_of<std::invalid_argument>([&] { open(""); }),
              HasSubstr("color_mode is 'fine'"));
}

TEST_F(Camera, ThatRefusesItsModesIsUsedAsItIs) {
  EXPECT_EQ(read_as("?refuse_modes=on&depth_modes=64x48@30,32x24@30").size(), kManyFrames);
  config_.depth_mode = "32x24@30";
  EXPECT_THAT(refusal("?refuse_modes=on&depth_modes=64x48@30,32x24@30"), HasSubstr("refuses"));
}

TEST_F(Camera, WithSlowColourColoursTheFramesItCan) {
  const auto frames = read_as("?color_modes=64x48@15");
  ASSERT_EQ(frames.size(), kManyFrames);
  for (int i = 0; i < kManyFrames; ++i) {
    EXPECT_EQ(has_color_of(frames[static_cast<std::size_t>(i)], i), i % 2 == 0) << i;
  }
  EXPECT_EQ(source_->status().counts.depth_unpaired, kManyFrames / 2);
}

TEST_F(Camera, WithLateColourIsPairedByTime) {
  const auto frames = read_as("?color_delay_ms=45");
  ASSERT_EQ(frames.size(), kManyFrames);
  for (int i = 0; i < kManyFrames; ++i) {
    EXPECT_TRUE(has_color_of(frames[static_cast<std::size_t>(i)], i)) << i;
  }
}

TEST_F(Camera, WithoutColourForAWhileGoesOnWithDepth) {
  const auto frames = read_as("?color_gap=5-20");
  ASSERT_EQ(frames.size(), kManyFrames);
  for (int i = 0; i < kManyFrames; ++i) {
    EXPECT_EQ(has_color_of(frames[static_cast<std::size_t>(i)], i), i < 4 || i >= 20) << i;
  }
  EXPECT_EQ(source_->status().counts.depth_unpaired, 16);
}

TEST_F(Camera, ThatLosesColourImagesLosesNoDepth) {
  const auto frames = read_as("?color_drop=0.3");
  ASSERT_EQ(frames.size(), kManyFrames);
  int colored = 0;
  for (int i = 0; i < kManyFrames; ++i) {
    const RgbdFrame& frame = frames[static_cast<std::size_t>(i)];
    if (frame.color_rgb.empty()) continue;
    ++colored;
    EXPECT_TRUE(has_color_of(frame, i)) << i << " has the colour of another";
  }
  EXPECT_GE(colored, kManyFrames / 2);
  EXPECT_EQ(source_->status().counts.depth_unpaired, kManyFrames - colored);
}

TEST_F(Camera, WithTwoClocksIsPairedOnceTheyAreKnown) {
  const auto frames = read_as("?color_clock_ms=5000");
  ASSERT_EQ(frames.size(), kManyFrames);
  // Nine images to learn the difference from, and those that waited meanwhile.
  for (int i = 15; i < kManyFrames; ++i) {
    EXPECT_TRUE(has_color_of(frames[static_cast<std::size_t>(i)], i)) << i;
  }
  EXPECT_THAT(kinds(), ElementsAre(Kind::kInformation));
}

TEST_F(Camera, WhoseClockJumpsHasFramesInAscendingTime) {
  for (const char* jump : {"-3000", "-100", "3000", "100"}) {
    const auto frames = read_as(std::string("?clock_jump_at=20&clock_jump_ms=") + jump);
    ASSERT_EQ(frames.size(), kManyFrames) << jump;
    expect_ascending(frames);
    for (int i = 0; i < kManyFrames; ++i) {
      // At the jump itself a colour image may have been taken before, and its depth image after.
      if (std::abs(i - 19) <= 2) continue;
      EXPECT_TRUE(has_color_of(frames[static_cast<std::size_t>(i)], i)) << jump << " ms, " << i;
    }
  }
}

TEST_F(Camera, ThatSendsBrokenImagesLosesOnlyThose) {
  for (const char* fault : {"empty", "misfit"}) {
    const auto frames = read_as(std::string("?") + fault + "_every=4");
    EXPECT_EQ(frames.size(), kManyFrames * 3 / 4) << fault;
    EXPECT_EQ(source_->status().counts.frames_bad, kManyFrames / 4) << fault;
    expect_depth_of(frames[0], 0);
  }
}

TEST_F(Camera, HasItsExposureLockedAtOnce) {
  config_.lock_exposure_after_s = 0.0;
  const auto frames = read_as("?exposure=on&color_gap=1-1");
  ASSERT_EQ(frames.size(), kManyFrames);
  const auto green = [&](std::size_t i) { return frames[i].color_rgb(20, 30)[1]; };
  for (std::size_t i = 2; i < kManyFrames; ++i) EXPECT_EQ(green(i), green(1)) << i;
  EXPECT_THAT(notices_, IsEmpty());
}

TEST_F(Camera, HasItsExposureLockedAfterAWhile) {
  config_.lock_exposure_after_s = 0.5;
  const auto frames = read_as("?exposure=on");
  ASSERT_EQ(frames.size(), kManyFrames);
  const auto green = [&](std::size_t i) { return frames[i].color_rgb(20, 30)[1]; };
  int changes = 0;
  for (std::size_t i = 1; i < 14; ++i) changes += green(i) == green(i - 1) ? 0 : 1;
  EXPECT_GT(changes, 6) << "adapting";
  for (std::size_t i = 19; i < kManyFrames; ++i) EXPECT_EQ(green(i), green(18)) << i;
}

TEST_F(Camera, WhoseColorHasAnotherClockHasItsExposureLockedAfterAWhile) {
  config_.lock_exposure_after_s = 0.5;
  const auto frames = read_as("?exposure=on&color_clock_ms=100000");
  std::set<std::uint8_t> greens;  // of the first half a second
  for (std::size_t i = 0; i < 14; ++i) {
    if (!frames.at(i).color_rgb.empty()) greens.insert(frames[i].color_rgb(20, 30)[1]);
  }
  EXPECT_GT(greens.size(), 4U) << "adapting";
}

TEST_F(Camera, WithoutSettingsSaysThatItsExposureIsNotLocked) {
  config_.lock_exposure_after_s = 0.0;
  EXPECT_EQ(read_as("").size(), kManyFrames);
  ASSERT_THAT(kinds(), ElementsAre(Kind::kWarning));
  EXPECT_THAT(notices_[0].text, HasSubstr("exposure cannot be locked"));
}

}  // namespace
}  // namespace kintsugi::mapper
