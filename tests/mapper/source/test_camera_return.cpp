// Cameras that go away and come back, as the driver imitates them.

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/source/open_source.hpp"
#include "tests/mapper/openni2_driver/recording_folder.hpp"

namespace kintsugi::mapper {
namespace {

using test::RecordingFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using Kind = SourceNotice::Kind;

constexpr int kManyFrames = 40;

class CameraThatGoesAway : public testing::Test {
 protected:
  void open(const std::string& options) {
    config_.device = folder_.uri() + options;
    config_.notify = [this](const SourceNotice& notice) { notices_.push_back(notice); };
    source_ = open_frame_source(config_);
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
  std::vector<Kind> kinds() const {
    std::vector<Kind> kinds;
    for (const auto& notice : notices_) kinds.push_back(notice.kind);
    return kinds;
  }

  RecordingFolder folder_{"50 51 31.5 23.5 64 48 1000\n", kManyFrames};
  SourceConfig config_;
  std::vector<SourceNotice> notices_;
  std::unique_ptr<FrameSource> source_;
};

/// 15 frames, then those from 480 ms later on: 15 frames are missed.
void expect_a_gap(const std::vector<RgbdFrame>& frames) {
  ASSERT_EQ(frames.size(), 25U);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto taken = static_cast<int>(i < 15 ? i : i + 15);
    const float depth_m = frames[i].depth_m(5, 9);
    const float expected_m = 0.001F * static_cast<float>(test::raw_depth(taken, 9, 5));
    EXPECT_NEAR(std::isnan(depth_m) ? 0.0F : depth_m, expected_m, 1e-6F) << i;
    EXPECT_EQ(cv::norm(frames[i].color_rgb, test::color_image(taken), cv::NORM_INF), 0.0) << i;
    EXPECT_EQ(frames[i].frame_index, static_cast<std::int64_t>(i) + 1) << "counted on";
  }
}

TEST_F(CameraThatGoesAway, IsWaitedForAndGoesOn) {
  open("?unplug_at=15&replug_after_ms=480");
  const auto frames = read();
  expect_a_gap(frames);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].utime, RecordingFolder::depth_utime(static_cast<int>(i < 15 ? i : i + 15)));
  }
  ASSERT_THAT(kinds(), ElementsAre(Kind::kInterrupted, Kind::kResumed));
  EXPECT_THAT(notices_[0].text, HasSubstr("it was disconnected; waiting for it"));
  EXPECT_THAT(notices_[1].text, HasSubstr("is back after"));
  EXPECT_EQ(source_->status().counts.interruptions, 1);
  EXPECT_EQ(source_->status().counts.frames_dropped, 0) << "what nobody sent was not dropped";
  EXPECT_EQ(source_->status().counts.depth_unpaired, 0);
  EXPECT_TRUE(source_->status().ended_well);
  EXPECT_EQ(source_->status().end_reason, "end of the recording");
}

TEST_F(CameraThatGoesAway, AndCountsItsTimeFromZeroGoesOnInOurs) {
  open("?unplug_at=15&replug_after_ms=480&restart_clock=on");
  const auto frames = read();
  expect_a_gap(frames);
  EXPECT_GE(frames[15].utime - frames[14].utime, 480'000) << "what has passed, at the least";
  for (std::size_t i = 16; i < frames.size(); ++i) {
    EXPECT_NEAR(static_cast<double>(frames[i].utime - frames[i - 1].utime), 33'333.0, 1.0);
  }
}

TEST_F(CameraThatGoesAway, InSilenceIsMissed) {
  config_.device_silence_s = 0.4;
  open("?camera=on&unplug_at=4&replug_after_ms=300&unplug_silently=on");
  const auto frames = read(8);
  ASSERT_EQ(frames.size(), 8U);
  for (std::size_t i = 1; i < 8; ++i) EXPECT_GT(frames[i].utime, frames[i - 1].utime);
  ASSERT_THAT(kinds(), ElementsAre(Kind::kInterrupted, Kind::kResumed));
  EXPECT_THAT(notices_[0].text, HasSubstr("no depth image came for 0."));
}

TEST_F(CameraThatGoesAway, ForGoodIsGivenUpAfterTheTimeSet) {
  config_.reconnect_s = 0.5;
  open("?unplug_at=3");
  EXPECT_EQ(read().size(), 3U);
  EXPECT_FALSE(source_->status().ended_well);
  EXPECT_THAT(source_->status().end_reason,
              testing::AllOf(HasSubstr("did not come back in"), HasSubstr("is not plugged in")));
  EXPECT_FALSE(source_->next());
}

TEST_F(CameraThatGoesAway, IsWaitedForUntilAskedToStop) {
  std::atomic<bool> stop = false;
  config_.stop_requested = [&] { return stop.load(); };
  open("?unplug_at=3");
  std::thread stopper([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(600));
    stop = true;
  });
  EXPECT_EQ(read().size(), 3U);
  stopper.join();
  EXPECT_TRUE(source_->status().ended_well);
  EXPECT_EQ(source_->status().end_reason, "stopped on request");
}

TEST_F(CameraThatGoesAway, HasItsExposureLockedAgain) {
  config_.lock_exposure_after_s = 0.1;
  open("?unplug_at=15&replug_after_ms=290&exposure=on");
  const auto frames = read();
  ASSERT_EQ(frames.size(), 31U);
  const auto green = [&](std::size_t i) { return frames[i].color_rgb(20, 30)[1]; };
  for (const auto& [first, last] : {std::pair{6U, 14U}, std::pair{21U, 30U}}) {
    for (std::size_t i = first; i < last; ++i) EXPECT_EQ(green(i), green(i + 1)) << i;
  }
}

TEST_F(CameraThatGoesAway, ThatSendsOnlyBrokenImagesIsOpenedAgain) {
  config_.device_silence_s = 0.3;
  config_.reconnect_s = 0.0;
  std::atomic<bool> stop = false;
  config_.stop_requested = [&] { return stop.load(); };
  open("?camera=on&empty_every=1");
  std::thread stopper([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(900));
    stop = true;
  });
  EXPECT_TRUE(read(1).empty());
  stopper.join();
  ASSERT_FALSE(notices_.empty());
  EXPECT_EQ(notices_[0].kind, Kind::kInterrupted);
  EXPECT_THAT(notices_[0].text, HasSubstr("the last image was refused: a frame of"));
}

/// Cameras that OpenNI2 lists, for as long as this lives.
class ListedCameras {
 public:
  explicit ListedCameras(const std::string& uris) { setenv("KINTSUGI_CAMERAS", uris.c_str(), 1); }
  ~ListedCameras() { unsetenv("KINTSUGI_CAMERAS"); }
  ListedCameras(const ListedCameras&) = delete;
  ListedCameras& operator=(const ListedCameras&) = delete;
};

TEST_F(CameraThatGoesAway, IsTheFirstCameraUnlessNamed) {
  const RecordingFolder other;
  const ListedCameras cameras(folder_.uri() + "?camera=on " + other.uri() + "?camera=on");
  config_.device = "";
  source_ = open_frame_source(config_);
  EXPECT_EQ(source_->status().name, "Kintsugi " + folder_.path().filename().string());
  EXPECT_EQ(read(1).size(), 1U);
}

TEST_F(CameraThatGoesAway, IsFoundUnderItsNewAddress) {
  const std::string options = "?unplug_at=15&replug_after_ms=480&new_port=on";
  const ListedCameras cameras(folder_.uri() + options);
  open(options);
  expect_a_gap(read());
  EXPECT_THAT(kinds(), ElementsAre(Kind::kInterrupted, Kind::kResumed));
}

TEST_F(CameraThatGoesAway, IsNotMistakenForAnotherOfItsKind) {
  const std::string options = "?unplug_at=15&replug_after_ms=480&new_port=on&serial_number=A";
  const ListedCameras cameras(folder_.uri() + "?serial_number=B " + folder_.uri() + options);
  open(options);
  expect_a_gap(read());
  EXPECT_THAT(kinds(), ElementsAre(Kind::kInterrupted, Kind::kResumed));
}

TEST_F(CameraThatGoesAway, IsWaitedForWhileOnlyAnotherOfItsKindIsThere) {
  const std::string options = "?unplug_at=15&serial_number=A";
  const ListedCameras cameras(folder_.uri() + "?serial_number=B " + folder_.uri() + options);
  config_.reconnect_s = 0.4;
  open(options);
  EXPECT_EQ(read().size(), 15U);
  EXPECT_THAT(source_->status().end_reason,
              HasSubstr("another camera is there: its serial number is B"));
}

}  // namespace
}  // namespace kintsugi::mapper
