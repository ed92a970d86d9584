#include <algorithm>
#include <filesystem>
#include <system_error>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "tests/support/file_size_limit.hpp"
#include "tests/support/temporary_folder.hpp"
#include "viewer/output/picture_file.hpp"
#include "viewer/output/video_file.hpp"

namespace kintsugi::viewer {
namespace {

namespace fs = std::filesystem;
using kintsugi::testing::FileSizeLimit;
using kintsugi::testing::TemporaryFolder;

bool is_empty(const TemporaryFolder& folder) { return fs::is_empty(folder.path()); }

TEST(WritePng, KeepsEveryPixelAndLeavesNothingBeside) {
  const TemporaryFolder folder;
  cv::Mat3b image(20, 30);
  cv::randu(image, 0, 256);
  write_png(folder / "a.png", image);
  EXPECT_EQ(0.0, cv::norm(image, cv::imread(folder / "a.png"), cv::NORM_INF));
  EXPECT_EQ(1, std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()));
}

TEST(WritePng, NamesTheFileThatCannotBeWritten) {
  const TemporaryFolder folder;
  try {
    write_png(folder / "missing/a.png", cv::Mat3b(2, 2));
    FAIL();
  } catch (const std::system_error& error) {
    EXPECT_NE(std::string::npos, std::string(error.what()).find("missing/a")) << error.what();
  }
  EXPECT_TRUE(is_empty(folder));
}

TEST(VideoFile, HasItsNameOnlyWhenFinishedAndHoldsEachFrame) {
  const TemporaryFolder folder;
  const fs::path path = folder / "a.mp4";
  VideoFile video(path, {64, 48}, 10.0);
  for (int i = 0; i < 25; ++i) video.add(cv::Mat3b(48, 64, cv::Vec3b(10, 10, 10 * i)));
  EXPECT_FALSE(fs::exists(path));
  video.finish();

  cv::VideoCapture capture(path.string());
  int frames = 0;
  for (cv::Mat frame; capture.read(frame); ++frames) {
    // Lossy: 4:2:0 and quantisation may shift a uniform colour by a few levels.
    EXPECT_NEAR(10 * frames, cv::mean(frame)[2], 6.0);
  }
  EXPECT_EQ(25, frames);
}

TEST(VideoFile, LeavesNothingWithoutFramesOrUnfinished) {
  const TemporaryFolder folder;
  VideoFile(folder / "a.mp4", {64, 48}, 10.0).finish();
  EXPECT_TRUE(is_empty(folder));
  VideoFile(folder / "b.mp4", {64, 48}, 10.0).add(cv::Mat3b(48, 64));
  EXPECT_TRUE(is_empty(folder));
}

TEST(VideoFile, IsWholeOrAbsentWhereverTheDiskEnds) {
  const TemporaryFolder folder;
  constexpr int kFrames = 5;
  const auto write = [](const fs::path& path) {
    VideoFile video(path, {64, 48}, 10.0);
    for (int i = 0; i < kFrames; ++i) video.add(cv::Mat3b(48, 64, cv::Vec3b(10, 10, 10 * i)));
    video.finish();
  };
  write(folder / "whole.mp4");
  const auto size = static_cast<rlim_t>(fs::file_size(folder / "whole.mp4"));
  int lost = 0;
  for (rlim_t limit = 1; limit < size; limit += 3) {
    const fs::path path = folder / "a.mp4";
    try {
      const FileSizeLimit disk(limit);
      write(path);
    } catch (const std::runtime_error&) {
      ++lost;
      EXPECT_EQ(1, std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()));
      continue;
    }
    cv::VideoCapture played(path.string());
    int frames = 0;
    for (cv::Mat frame; played.read(frame);) ++frames;
    EXPECT_EQ(kFrames, frames) << limit << " of " << size << " bytes";
    fs::remove(path);
  }
  EXPECT_GT(lost, 0);
}

TEST(VideoFile, RefusesWhatItCannotWrite) {
  const TemporaryFolder folder;
  EXPECT_THROW(VideoFile(folder / "a.avi", {64, 48}, 10.0), std::invalid_argument);
  EXPECT_THROW(VideoFile(folder / "missing/a.mp4", {64, 48}, 10.0), std::runtime_error);
  VideoFile video(folder / "a.mp4", {64, 48}, 10.0);
  EXPECT_THROW(video.add(cv::Mat3b(10, 10)), std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi::viewer
