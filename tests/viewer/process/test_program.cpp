// kintsugi-viewer as a program: draws pictures from a log.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "tests/support/temporary_folder.hpp"
#include "tests/viewer/support/patched_room.hpp"
#include "tests/viewer/support/recorded_room.hpp"
#include "tests/viewer/support/viewer_program.hpp"

namespace kintsugi::viewer {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
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

TEST(ViewerProcess, DrawsALogAtIntervalsOfMapTimeAndTheFinalMap) {
  const TemporaryFolder folder;
  write_log(folder / "room.log", make_room(kLength_m, kResolution_m));

  EXPECT_EQ(0, run({"--log", folder / "room.log", "--out", folder / "out", "--size", "640x360",
                    "--every", "3", "--plots"}));

  const std::vector<std::string> expected{
      "final.png",           "map_final.png",        "plots.png",
      "segments_final.png",  "snapshot_0003.0s.png", "snapshot_0006.0s.png",
      "snapshot_0009.0s.png"};
  EXPECT_EQ(expected, names_in(folder / "out"));
  for (const char* name : {"final.png", "map_final.png", "segments_final.png",
                           "snapshot_0003.0s.png", "snapshot_0009.0s.png"}) {
    EXPECT_EQ(cv::Size(640, 360), size_of(folder / "out" / name)) << name;
  }
}

TEST(ViewerProcess, FailsWhenALogHasNothingOfTheMap) {
  const TemporaryFolder folder;
  write_log(folder / "room.log", make_room(kLength_m, kResolution_m));
  EXPECT_EQ(1, run({"--log", folder / "room.log", "--out", folder / "out", "--map-name", "hall"}));
  EXPECT_TRUE(names_in(folder / "out").empty());
}

TEST(ViewerProcess, NamesFlagsAndDegreesOfWrongAngles) {
  const TemporaryFolder folder;
  const auto output_of = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "--check");
    EXPECT_NE(0, Program(std::move(arguments), 0, folder / "output.txt").wait());
    return std::string(std::istreambuf_iterator<char>(std::ifstream(folder / "output.txt").rdbuf()),
                       {});
  };
  EXPECT_THAT(output_of({"--overview-pitch", "200"}),
              HasSubstr("--overview-pitch: Value 200 not in range -85"));
  EXPECT_THAT(output_of({"--overview-yaw", "inf"}), HasSubstr("--overview-yaw: 'inf'"));
}

TEST(ViewerProcess, ChecksTheFilesAndTheBusThatARunOpens) {
  const TemporaryFolder folder;
  write_log(folder / "room.log", make_room(kLength_m, kResolution_m));
  EXPECT_EQ(0, run({"--check", "--log", folder / "room.log", "--video", "room.mp4"}));
  EXPECT_EQ(1, run({"--check", "--log", folder / "nowhere.log"}));
  EXPECT_EQ(1, run({"--check", "--video", "room.avi"}));
  EXPECT_EQ(1, run({"--check", "--lcm-url", "foo://"}));
}

TEST(ViewerProcess, DrawsAMapThatNobodySegments) {
  const TemporaryFolder folder;
  write_log(folder / "room.log", make_room(kLength_m, kResolution_m), {.updates = false});

  EXPECT_EQ(0, run({"--log", folder / "room.log", "--out", folder / "out", "--size", "640x360",
                    "--every", "3"}));

  EXPECT_TRUE(fs::exists(folder / "out/snapshot_0003.0s.png"));
  EXPECT_TRUE(fs::exists(folder / "out/final.png"));
}

/// Duration of a video, s; its frames are decoded. Checks their size.
double duration_s(const fs::path& path, cv::Size size) {
  cv::VideoCapture video(path.string());
  int frames = 0;
  for (cv::Mat frame; video.read(frame); ++frames) EXPECT_EQ(size, frame.size());
  return frames / video.get(cv::CAP_PROP_FPS);
}

/// From the first message to the last, in map time.
double duration_s(const SyntheticMap& room) {
  return 1e-6 * static_cast<double>(std::max(room.poses.back().utime, room.slices.back().utime) -
                                    room.poses.front().utime);
}

TEST(ViewerProcess, WritesAVideoThatTakesAsLongAsTheRun) {
  const TemporaryFolder folder;
  SyntheticMap room = make_room(kLength_m, kResolution_m);
  // Two seconds without anything.
  const std::int64_t middle = room.poses[room.poses.size() / 2].utime;
  const auto is_in_gap = [&](const CameraPose& pose) {
    return pose.utime > middle && pose.utime < middle + 2'000'000;
  };
  std::erase_if(room.poses, is_in_gap);
  // The video begins with the first slice.
  std::erase_if(room.poses,
                [&](const CameraPose& pose) { return pose.utime < room.slices.front().utime; });
  write_log(folder / "room.log", room);
  for (const char* rate : {"10", "4"}) {
    EXPECT_EQ(0, run({"--log", folder / "room.log", "--out", folder / "out", "--size", "320x180",
                      "--video", folder / "room.mp4", "--video-rate", rate}));
    EXPECT_NEAR(duration_s(room), duration_s(folder / "room.mp4", {320, 180}), 2.0 / 4.0) << rate;
  }
  EXPECT_EQ(std::vector<std::string>({"out", "room.log", "room.mp4"}), names_in(folder.path()));
}

TEST(ViewerProcess, ShowsTheCamerasImageFromItsFirstViewOn) {
  const TemporaryFolder folder;
  const SyntheticMap room = make_patched_room(2.5, kResolution_m);
  write_log(folder / "room.log", room);
  EXPECT_EQ(0, run({"--log", folder / "room.log", "--out", folder / "out", "--size", "640x360",
                    "--video", folder / "room.mp4", "--every", "2"}));
  EXPECT_NEAR(duration_s(room), duration_s(folder / "room.mp4", {640, 360}), 0.25);
  EXPECT_TRUE(fs::exists(folder / "out/snapshot_0002.0s.png"));
  cv::Mat first;
  ASSERT_TRUE(cv::VideoCapture((folder / "room.mp4").string()).read(first));
  const cv::Mat camera = first(cv::Rect(0, 40, 400, 240));  // without the title
  EXPECT_GT(cv::mean(camera)[0], 60.0);                     // of the walls; the background is dark
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
