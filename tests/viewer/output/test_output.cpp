#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "tests/support/file_size_limit.hpp"
#include "tests/support/temporary_folder.hpp"
#include "viewer/output/picture_file.hpp"
#include "viewer/output/video_clock.hpp"
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
  for (int i = 0; i < 25; ++i) video.add(cv::Mat3b(48, 64, cv::Vec3b::all(10 * i)));
  EXPECT_FALSE(fs::exists(path));
  video.finish();

  cv::VideoCapture capture(path.string());
  int frames = 0;
  for (cv::Mat frame; capture.read(frame); ++frames) {
    // Lossy: quantisation may shift a grey by a few levels. (OpenCV decodes colours by BT.601.)
    EXPECT_NEAR(10 * frames, cv::mean(frame)[2], 6.0);
  }
  EXPECT_EQ(25, frames);
}

TEST(VideoFile, IsWhatBrowsersPlay) {
  const TemporaryFolder folder;
  const fs::path path = folder / "a.mp4";
  VideoFile video(path, {65, 49}, 12.5);
  for (int i = 0; i < 25; ++i) video.add(cv::Mat3b(49, 65, cv::Vec3b(10, 10, 10 * i)));
  video.finish();

  cv::VideoCapture capture(path.string());
  const auto is = [&](int property, char a, char b, char c, char d) {
    return static_cast<int>(capture.get(property)) == cv::VideoWriter::fourcc(a, b, c, d);
  };
  EXPECT_TRUE(is(cv::CAP_PROP_FOURCC, 'h', '2', '6', '4') ||
              is(cv::CAP_PROP_FOURCC, 'a', 'v', 'c', '1'));
  EXPECT_TRUE(is(cv::CAP_PROP_CODEC_PIXEL_FORMAT, 'I', '4', '2', '0'));  // yuv420p
  EXPECT_EQ(12.5, capture.get(cv::CAP_PROP_FPS));
  EXPECT_EQ(25.0, capture.get(cv::CAP_PROP_FRAME_COUNT));
  EXPECT_EQ(64.0, capture.get(cv::CAP_PROP_FRAME_WIDTH));
  EXPECT_EQ(48.0, capture.get(cv::CAP_PROP_FRAME_HEIGHT));

  std::ifstream file(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), {});
  EXPECT_LT(bytes.find("moov"), bytes.find("mdat"));  // the index before the frames
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

TEST(VideoClock, HasOnePictureForEachPeriodOfMapTimeHoweverItPasses) {
  constexpr std::int64_t kStart = 77'000'000;
  for (const std::int64_t step : {1'000, 33'333, 100'000, 250'000, 3'000'000}) {
    VideoClock clock(10.0);
    std::int64_t pictures = 0;
    for (std::int64_t utime = kStart; utime <= kStart + 30'000'000; utime += step) {
      const int due = clock.due(utime);
      pictures += due;
      if (due > 0) clock.note(utime, due);
      EXPECT_EQ(0, clock.due(utime));
      EXPECT_EQ((utime - kStart) / 100'000 + 1, pictures) << step;
    }
  }
}

TEST(VideoClock, GoesOnWithThePicturesOfAnotherRecording) {
  VideoClock clock(10.0);
  std::int64_t pictures = 0;
  for (const std::int64_t start : {50'000'000, 10'000'000, 2'000'000'000}) {
    for (std::int64_t utime = start; utime <= start + 1'000'000; utime += 50'000) {
      const int due = clock.due(utime);
      EXPECT_LE(due, 1);
      pictures += due;
      if (due > 0) clock.note(utime, due);
    }
  }
  EXPECT_EQ(33, pictures);
}

}  // namespace
}  // namespace kintsugi::viewer
