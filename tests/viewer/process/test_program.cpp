// kintsugi-viewer as a program: draws pictures from a log.

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "tests/support/temporary_folder.hpp"
#include "tests/viewer/support/recorded_room.hpp"
#include "tests/viewer/support/viewer_program.hpp"

namespace kintsugi::viewer {
namespace {

namespace fs = std::filesystem;
using testing::TemporaryFolder;

constexpr double kLength_m = 5.0;  // 20 slices
constexpr double kResolution_m = 0.05;

int run(std::vector<std::string> arguments, rlim_t max_file_bytes = 0) {
  return Program(std::move(arguments), max_file_bytes).wait();
}

cv::Size size_of(const fs::path& picture) { return cv::imread(picture.string()).size(); }

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename());
  std::ranges::sort(names);
  return names;
}

TEST(ViewerProcess, DrawsEachTenthSliceOfALogAndTheFinalMap) {
  const TemporaryFolder folder;
  write_log(folder / "room.log", make_room(kLength_m, kResolution_m));

  EXPECT_EQ(0, run({"--log", folder / "room.log", "--out", folder / "out", "--size", "640x360",
                    "--plots"}));

  const std::vector<std::string> expected{"final.png",           "map_final.png",
                                          "plots.png",           "segments_final.png",
                                          "snapshot_000009.png", "snapshot_000019.png"};
  EXPECT_EQ(expected, names_in(folder / "out"));
  for (const char* name : {"final.png", "map_final.png", "segments_final.png",
                           "snapshot_000009.png", "snapshot_000019.png"}) {
    EXPECT_EQ(cv::Size(640, 360), size_of(folder / "out" / name)) << name;
  }
}

TEST(ViewerProcess, DrawsAMapThatNobodySegments) {
  const TemporaryFolder folder;
  write_log(folder / "room.log", make_room(kLength_m, kResolution_m), {.updates = false});

  EXPECT_EQ(0, run({"--log", folder / "room.log", "--out", folder / "out", "--size", "640x360"}));

  EXPECT_TRUE(fs::exists(folder / "out/snapshot_000009.png"));
  EXPECT_TRUE(fs::exists(folder / "out/final.png"));
}

TEST(ViewerProcess, WritesAVideoThatPlaysBack) {
  const TemporaryFolder folder;
  const SyntheticMap room = make_room(kLength_m, kResolution_m);
  write_log(folder / "room.log", room);

  EXPECT_EQ(0, run({"--log", folder / "room.log", "--out", folder / "out", "--size", "320x180",
                    "--video", folder / "room.mp4", "--video-period", "0.5"}));

  // A frame at the first slice, and one for each half second of map time after it; poses come every
  // 1/30 s, so a frame may be that much late and the count one or two smaller.
  const double seconds =
      1e-6 * static_cast<double>(std::max(room.poses.back().utime, room.slices.back().utime) -
                                 room.slices.front().utime);
  cv::VideoCapture video((folder / "room.mp4").string());
  int frames = 0;
  for (cv::Mat frame; video.read(frame); ++frames) EXPECT_EQ(cv::Size(320, 180), frame.size());
  EXPECT_NEAR(1 + seconds / 0.5, frames, 2.0);
  EXPECT_EQ(std::vector<std::string>({"out", "room.log", "room.mp4"}), names_in(folder.path()));
}

TEST(ViewerProcess, KeepsTheFinalPicturesOfAnEarlierSession) {
  const TemporaryFolder folder;
  const SyntheticMap room = make_room(kLength_m, kResolution_m);
  write_log(folder / "room.log", room);
  write_log(folder / "room.log", room, {.session_offset = 5}, true);

  EXPECT_EQ(0, run({"--log", folder / "room.log", "--out", folder / "out", "--size", "320x180"}));

  const std::string session = std::to_string(room.slices.front().session);
  EXPECT_TRUE(fs::exists(folder / ("out/final_" + session + ".png")));
  EXPECT_TRUE(fs::exists(folder / "out/final.png"));
}

TEST(ViewerProcess, ReportsAFullDiskAndLeavesNothingHalfWritten) {
  const TemporaryFolder folder;
  write_log(folder / "room.log", make_room(kLength_m, kResolution_m));

  constexpr rlim_t kMaxFileBytes = 8192;  // smaller than any of the pictures
  EXPECT_EQ(1, run({"--log", folder / "room.log", "--out", folder / "out", "--size", "640x360",
                    "--video", folder / "room.mp4"},
                   kMaxFileBytes));

  EXPECT_EQ(std::vector<std::string>(), names_in(folder / "out"));
  EXPECT_EQ(std::vector<std::string>({"out", "room.log"}), names_in(folder.path()));
}

TEST(ViewerProcess, DrawsWhatATruncatedLogHolds) {
  const TemporaryFolder folder;
  write_log(folder / "room.log", make_room(kLength_m, kResolution_m));
  fs::resize_file(folder / "room.log", fs::file_size(folder / "room.log") - 100);

  EXPECT_EQ(1, run({"--log", folder / "room.log", "--out", folder / "out", "--size", "320x180"}));

  EXPECT_TRUE(fs::exists(folder / "out/final.png"));
}

TEST(ViewerProcess, RefusesWhatItCannotRun) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a_file") << "not a folder";
  EXPECT_NE(0, run({"--log", folder / "missing.log", "--out", folder / "out"}));
  EXPECT_NE(0, run({"--log", folder / "a_file", "--out", folder / "out"}));
  EXPECT_NE(0, run({"--log", folder / "a_file", "--out", folder / "a_file/out"}));
  EXPECT_NE(0, run({"--every", "0"}));
  EXPECT_NE(0, run({"--view", "1,2,3"}));
  EXPECT_NE(0, run({"--size", "1280"}));
  EXPECT_NE(0, run({"--size", "0x720"}));
  EXPECT_NE(0, run({"--highlight", "-1"}));
  EXPECT_NE(0, run({"--timeline", "0"}));
  EXPECT_NE(0, run({"--timeline", "1,x"}));
  EXPECT_NE(0, run({"--unknown"}));
}

}  // namespace
}  // namespace kintsugi::viewer
