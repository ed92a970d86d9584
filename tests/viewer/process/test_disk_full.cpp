// kintsugi-viewer while its disk is full and when it has room again. The disk is a tmpfs of a few
// megabytes that only this test sees.

#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "lcmtypes/bus/message_subscriber.hpp"
#include "lcmtypes/channels.hpp"
#include "tests/support/private_bus.hpp"
#include "tests/support/small_disk.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/viewer/support/recorded_room.hpp"
#include "tests/viewer/support/viewer_program.hpp"
#include "viewer/output/video_recorder.hpp"

namespace kintsugi::viewer {
namespace {

namespace fs = std::filesystem;
constexpr auto npos = std::string::npos;
using testing::TemporaryFolder;

/// Files in this folder are on a small disk of their own.
class DiskFull : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const auto why_not = testing::enter_private_bus()) GTEST_SKIP() << *why_not;
    if (const auto why_not = disk_.mount("6000000")) GTEST_SKIP() << *why_not;
    bus_ = std::make_unique<Bus>(testing::kPrivateBusUrl);
    subscribe<ViewerStatus>(*bus_, channels::kViewerStatus,
                            [this](const ViewerStatus& status) { status_ = status; });
  }

  void fill_disk(std::uintmax_t bytes_left = 0) const {
    std::ofstream file(folder_ / "filler", std::ios::binary | std::ios::app);
    const std::string block(4096, 'x');
    while (fs::space(folder_.path()).available > bytes_left &&
           file.write(block.data(), 4096).flush()) {
    }
  }
  void empty_disk() const { fs::remove(folder_ / "filler"); }

  template <class Condition>
  bool wait_until(Condition&& done, RoomOnBus* room = nullptr) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(2);
    while (!done() && std::chrono::steady_clock::now() < deadline) {
      bus_->handle(std::chrono::milliseconds(20));
      if (room != nullptr) room->serve();
    }
    return done();
  }

  const TemporaryFolder folder_;
  testing::SmallDisk disk_{folder_.path()};
  std::unique_ptr<Bus> bus_;
  std::optional<ViewerStatus> status_;
};

TEST_F(DiskFull, KeepsTheViewerFromNothingButItsFilesAndGetsThemWhenThereIsRoom) {
  const SyntheticMap map = make_room(7.5, 0.05);  // 30 slices, one each half second
  RoomOnBus room(*bus_, map);
  Program program({"--lcm-url", testing::kPrivateBusUrl, "--out", folder_ / "out", "--size",
                   "640x360", "--every", "2.2", "--video", folder_ / "room.mp4",
                   "--exit-on-final"});
  ASSERT_TRUE(wait_until([&] { return status_.has_value(); }));
  room.publish(5);
  ASSERT_TRUE(wait_until([&] { return status_->snapshots_written == 1; }, &room));
  EXPECT_EQ("", status_->problem);

  fill_disk();
  room.publish(5);
  // Not the problem of the video, which may be reported before.
  ASSERT_TRUE(wait_until([&] { return status_->problem.find("No space left") != npos; }, &room))
      << status_->problem;
  EXPECT_EQ(10, status_->updates_applied);
  EXPECT_EQ(1, status_->snapshots_written);

  empty_disk();
  room.publish(5);
  ASSERT_TRUE(wait_until(
      [&] { return status_->snapshots_written == 2 && status_->problem.empty(); }, &room))
      << status_->problem;

  fill_disk();
  room.publish(15);  // the final pictures cannot be written; the viewer waits
  ASSERT_TRUE(wait_until(
      [&] { return status_->updates_applied == 30 && !status_->problem.empty(); }, &room));
  EXPECT_FALSE(status_->finished);
  empty_disk();
  ASSERT_TRUE(wait_until([&] { return program.has_ended(); }, &room));
  EXPECT_EQ(1, program.wait());  // snapshots are missing

  int num_pictures = 0;
  for (const auto& entry : fs::directory_iterator(folder_ / "out")) {
    EXPECT_EQ(".png", entry.path().extension());  // nothing half-written
    EXPECT_EQ(cv::Size(640, 360), cv::imread(entry.path().string()).size()) << entry.path();
    ++num_pictures;
  }
  EXPECT_GE(num_pictures, 5);
  EXPECT_TRUE(cv::VideoCapture((folder_ / "room.mp4").string()).isOpened());
}

TEST_F(DiskFull, LeavesFramesOutOfAVideoThatPlaysBack) {
  constexpr int kFrames = 40;
  VideoRecorder video(folder_ / "a.mp4", {320, 240}, 10.0);
  cv::Mat3b noise(240, 320);
  for (int i = 0; i < kFrames; ++i) {
    cv::randu(noise, 0, 256);
    video.add(noise);
  }
  EXPECT_EQ("", video.problem());
  fill_disk(1'000'000);
  for (int i = 0; i < kFrames; ++i) video.add(noise);
  EXPECT_NE(npos, video.problem().find("a.mp4")) << video.problem();
  empty_disk();
  for (int i = 0; i < kFrames; ++i) video.add(noise);
  EXPECT_EQ("", video.problem());
  fill_disk(400'000);  // room for the index
  EXPECT_TRUE(video.finish());

  cv::VideoCapture played((folder_ / "a.mp4").string());
  int frames = 0;
  for (cv::Mat frame; played.read(frame);) ++frames;
  EXPECT_EQ(2 * kFrames, frames);
}

TEST_F(DiskFull, SaysThatAVideoIsLostAndLeavesNothing) {
  auto video = std::make_unique<VideoRecorder>(folder_ / "a.mp4", cv::Size(320, 240), 10.0);
  cv::Mat3b noise(240, 320);  // larger than a page even when compressed
  cv::randu(noise, 0, 256);
  video->add(noise);
  fill_disk();
  EXPECT_FALSE(video->finish());
  EXPECT_NE(npos, video->problem().find("No space left")) << video->problem();
  EXPECT_FALSE(fs::exists(folder_ / "a.mp4"));
  video.reset();
  empty_disk();
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

}  // namespace
}  // namespace kintsugi::viewer
