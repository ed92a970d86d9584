#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "mapper/openni2_driver/recording/imitated_recording.hpp"
#include "mapper/openni2_driver/recording/recording_uri.hpp"
#include "mapper/openni2_driver/recording/synthetic_recording.hpp"
#include "mapper/synthetic/render/sequence.hpp"

namespace kintsugi::synthetic {
namespace {

using testing::HasSubstr;

std::string error_of(const std::map<std::string, std::string>& options) {
  try {
    Sequence(Sequence::Config::parse("box-room", options));
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(Sequence, OptionsAreReadAndWrongOnesNamed) {
  const auto config = Sequence::Config::parse("loop", {{"noise", "off"},
                                                       {"seed", "9"},
                                                       {"frames", "30"},
                                                       {"start", "12"},
                                                       {"sensor", "d435"},
                                                       {"speed", "0.5"},
                                                       {"rate", "15"}});
  EXPECT_EQ(config.scene, "loop");
  EXPECT_EQ(config.sensor, "d435");
  EXPECT_EQ(config.speed, 0.5);
  EXPECT_EQ(config.rate_hz, 15);
  EXPECT_FALSE(config.noise);
  EXPECT_EQ(config.seed, 9U);
  EXPECT_EQ(config.frames, 30);
  EXPECT_EQ(config.start, 12);
  EXPECT_THAT(error_of({{"nose", "off"}}), HasSubstr("nose"));
  EXPECT_THAT(error_of({{"nose", "off"}}), HasSubstr("sensor=clean|d435|kinect1|kinect2|lidar"));
  EXPECT_THAT(error_of({{"noise", "maybe"}}), HasSubstr("on or off"));
  EXPECT_THAT(error_of({{"sensor", "sonar"}}), HasSubstr("kinect1 kinect2 lidar"));
  EXPECT_THAT(error_of({{"speed", "fast"}}), HasSubstr("expected a number"));
  EXPECT_THAT(error_of({{"speed", "0"}}), HasSubstr("within [0.1, 10]"));
  EXPECT_THAT(error_of({{"speed", "nan"}}), HasSubstr("within [0.1, 10]"));
  EXPECT_THAT(error_of({{"rate", "60"}}), HasSubstr("30, 15, 10, 6, 5, 3, 2 or 1"));
  EXPECT_THAT(error_of({{"seed", "-1"}}), HasSubstr("whole number"));
  EXPECT_THAT(error_of({{"seed", "1x"}}), HasSubstr("1x"));
  EXPECT_THAT(error_of({{"start", "241"}}), HasSubstr("within [0, 240]"));
  EXPECT_THAT(error_of({{"frames", "0"}}), HasSubstr("within [1, 241]"));
  EXPECT_THAT(error_of({{"start", "200"}, {"frames", "42"}}), HasSubstr("within [1, 41]"));
}

TEST(Sequence, PartOfAPathIsThatPartOfTheWhole) {
  Sequence whole(Sequence::Config::parse("box-room", {}));
  Sequence part(Sequence::Config::parse("box-room", {{"start", "100"}, {"frames", "5"}}));
  EXPECT_EQ(part.num_frames(), 5);
  EXPECT_EQ(part.utime(3), whole.utime(103));
  EXPECT_TRUE(part.X_WC(3).isApprox(whole.X_WC(103), 0.0));
  const cv::Mat_<std::uint16_t> a = part.depth_mm(3);
  (void)whole.depth_mm(7);  // whichever order
  const cv::Mat_<std::uint16_t> b = whole.depth_mm(103);
  EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end()));
  EXPECT_THROW((void)part.X_WC(5), std::out_of_range);
}

TEST(Sequence, ImagesHaveTheSizeAndGeometryOfTheSensor) {
  struct Expected {
    int width;
    int height;
    double focal_length_px;
  };
  const std::map<std::string, Expected> expected = {{"kinect1", {640, 480, 525}},
                                                    {"kinect2", {512, 424, 365}},
                                                    {"d435", {640, 480, 615}},
                                                    {"lidar", {256, 192, 212}},
                                                    {"clean", {640, 480, 525}}};
  for (const auto& [name, camera] : expected) {
    Sequence sequence(Sequence::Config::parse("box-room", {{"sensor", name}}));
    EXPECT_EQ(sequence.intrinsics(),
              centred_camera(camera.width, camera.height, camera.focal_length_px))
        << name;
    const cv::Size size(camera.width, camera.height);
    EXPECT_EQ(sequence.depth_mm(3).size(), size) << name;
    EXPECT_EQ(sequence.truth(3).color_rgb.size(), size) << name;
    EXPECT_EQ(sequence.truth(3).intrinsics, sequence.intrinsics()) << name;
  }
}

TEST(Sequence, DefaultSensorIsTheFirstKinect) {
  Sequence given(Sequence::Config::parse("box-room", {{"sensor", "kinect1"}}));
  Sequence by_default(Sequence::Config::parse("box-room", {}));
  const cv::Mat_<std::uint16_t> a = given.depth_mm(5);
  const cv::Mat_<std::uint16_t> b = by_default.depth_mm(5);
  EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end()));
}

TEST(Sequence, SpeedChangesWhenTheCameraIsSomewhereButNotWhere) {
  const Sequence once(Sequence::Config::parse("box-room", {}));
  const Sequence twice(Sequence::Config::parse("box-room", {{"speed", "2"}}));
  const Sequence half(Sequence::Config::parse("box-room", {{"speed", "0.5"}}));
  ASSERT_EQ(once.num_frames(), 241);
  EXPECT_EQ(twice.num_frames(), 121);
  EXPECT_EQ(half.num_frames(), 481);
  for (const int frame : {0, 1, 17, 60, 120}) {
    EXPECT_EQ(twice.utime(frame), once.utime(frame));
    EXPECT_TRUE(twice.X_WC(frame).isApprox(once.X_WC(2 * frame), 0.0)) << frame;
    EXPECT_TRUE(half.X_WC(2 * frame).isApprox(once.X_WC(frame), 0.0)) << frame;
  }
}

TEST(Sequence, AtFifteenHertzItIsEverySecondFrame) {
  const Sequence all(Sequence::Config::parse("box-room", {}));
  const Sequence every_second(Sequence::Config::parse("box-room", {{"rate", "15"}}));
  const Sequence part(
      Sequence::Config::parse("box-room", {{"rate", "15"}, {"start", "10"}, {"frames", "3"}}));
  EXPECT_EQ(every_second.num_frames(), 121);
  EXPECT_EQ(every_second.utime(1), 66'667);
  EXPECT_EQ(every_second.utime(15), 1'000'000);
  for (const int frame : {0, 1, 17, 120}) {
    EXPECT_EQ(every_second.utime(frame), all.utime(2 * frame));
    EXPECT_TRUE(every_second.X_WC(frame).isApprox(all.X_WC(2 * frame), 0.0)) << frame;
  }
  EXPECT_EQ(part.utime(1), every_second.utime(11));
  EXPECT_TRUE(part.X_WC(1).isApprox(every_second.X_WC(11), 0.0));
}

Sequence patrol(const std::map<std::string, std::string>& more) {
  std::map<std::string, std::string> options = {{"rate", "5"}, {"sensor", "lidar"}, {"laps", "40"}};
  options.insert(more.begin(), more.end());
  return Sequence(Sequence::Config::parse("patrol", options));
}

/// Where its things are, those of the building too.
std::vector<Pose> places_in(int lap, std::uint32_t seed) {
  std::vector<Pose> places;
  const Scene scene = make_scene_in_lap("patrol", seed, lap);
  for (const Instance& instance : scene.instances()) places.push_back(instance.X_WG);
  return places;
}

TEST(Sequence, InPatrolOneThingMovesAtMostBetweenTwoLapsAsTheSeedSays) {
  int num_moves = 0;
  for (int lap = 1; lap < 40; ++lap) {
    const auto before = places_in(lap - 1, 1);
    const auto after = places_in(lap, 1);
    ASSERT_EQ(before.size(), after.size());
    int moved = 0;
    for (std::size_t i = 0; i < after.size(); ++i) {
      moved += before[i].isApprox(after[i], 0.0) ? 0 : 1;
    }
    EXPECT_LE(moved, 1) << lap;
    num_moves += moved;
  }
  EXPECT_GE(num_moves, 20) << "now and then";
  const auto are_equal = [](const std::vector<Pose>& a, const std::vector<Pose>& b) {
    return std::ranges::equal(a, b,
                              [](const Pose& x, const Pose& y) { return x.isApprox(y, 0.0); });
  };
  EXPECT_TRUE(are_equal(places_in(30, 1), places_in(30, 1)));
  EXPECT_FALSE(are_equal(places_in(30, 1), places_in(30, 2)));
  EXPECT_TRUE(are_equal(places_in(0, 1), places_in(0, 2))) << "they begin alike";
}

TEST(Sequence, PatrolIsWalkedAgainInTheSceneOfTheLap) {
  constexpr int kFramesOfLap = 500;
  Sequence walk = patrol({});
  EXPECT_EQ(walk.num_frames(), 40 * kFramesOfLap + 1);
  EXPECT_EQ(walk.lap_of(kFramesOfLap - 1), 0);
  EXPECT_EQ(walk.lap_of(kFramesOfLap), 1);
  EXPECT_EQ(walk.lap_of(40 * kFramesOfLap), 39);
  // Whichever order the frames are asked for, and wherever the sequence begins.
  Sequence later = patrol({{"start", "15000"}, {"frames", "300"}});
  EXPECT_EQ(later.lap_of(0), 30);
  const cv::Mat_<std::uint16_t> a = walk.depth_mm(15'200);
  (void)walk.depth_mm(200);
  const cv::Mat_<std::uint16_t> b = walk.depth_mm(15'200);
  const cv::Mat_<std::uint16_t> c = later.depth_mm(200);
  EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end()));
  EXPECT_TRUE(std::equal(a.begin(), a.end(), c.begin(), c.end()));
}

TEST(Sequence, WhatMovesInPatrolIsNotSeenBetweenTwoLaps) {
  const Sequence walk = patrol({});
  for (const int lap : {1, 2, 7, 20, 39}) {
    const Pose X_WC = walk.X_WC(500 * lap);
    const RenderedFrame before =
        render(make_scene_in_lap("patrol", 1, lap - 1), walk.intrinsics(), X_WC);
    const RenderedFrame after =
        render(make_scene_in_lap("patrol", 1, lap), walk.intrinsics(), X_WC);
    EXPECT_TRUE(std::equal(before.depth_m.begin(), before.depth_m.end(), after.depth_m.begin(),
                           [](float x, float y) { return x == y || (x != x && y != y); }))
        << lap;
  }
}

TEST(Sequence, RecordingsHaveTheRateOfTheirFramesAndNoDepthBeyondTheirUnit) {
  const mapper::SyntheticRecording recording(Sequence::Config::parse("box-room", {{"rate", "15"}}));
  EXPECT_EQ(recording.frame_rate_hz(), 15);
  EXPECT_EQ(recording.depth_utime(3), 200'000);
  // Units of 0.1 mm end at 6.55 m; the corridor is longer.
  mapper::SyntheticRecording corridor(Sequence::Config::parse("corridor", {{"sensor", "clean"}}));
  const cv::Mat_<std::uint16_t> mm = corridor.depth(0, mapper::DepthUnit::k1mm);
  const cv::Mat_<std::uint16_t> tenths = corridor.depth(0, mapper::DepthUnit::k100um);
  int beyond = 0;
  for (int v = 0; v < mm.rows; ++v) {
    for (int u = 0; u < mm.cols; ++u) {
      beyond += mm(v, u) > 6553 ? 1 : 0;
      ASSERT_EQ(tenths(v, u), mm(v, u) > 6553 ? 0 : 10 * mm(v, u));
    }
  }
  EXPECT_GT(beyond, 0);
}

TEST(Sequence, ScenesOpenAsRecordingsOfTheDriver) {
  const auto uri = mapper::parse_recording_uri("synthetic://box-room?noise=off&frames=3");
  const auto recording = mapper::open_recording(*uri);
  EXPECT_EQ(recording->name(), "synthetic://box-room");
  EXPECT_EQ(recording->num_depth_frames(), 3);
  EXPECT_EQ(recording->depth_utime(2), 66667);
  const cv::Mat_<std::uint16_t> mm = recording->depth(1, mapper::DepthUnit::k1mm);
  const cv::Mat_<std::uint16_t> tenths = recording->depth(1, mapper::DepthUnit::k100um);
  EXPECT_GT(mm(240, 320), 400);
  EXPECT_EQ(tenths(240, 320), 10 * mm(240, 320));
  EXPECT_EQ(recording->color(1).size(), mm.size());
  EXPECT_TRUE(recording->depth_X_WC(1).has_value());
}

TEST(Sequence, ColourCanBeSwitchedOffAsOfAnyDevice) {
  const auto uri = mapper::parse_recording_uri("synthetic://kitchen?color=off&sensor=lidar");
  EXPECT_FALSE(uri->imitation.color);
  EXPECT_EQ(uri->options, (std::map<std::string, std::string>{{"sensor", "lidar"}}));
  mapper::ImitatedRecording recording(mapper::open_recording(*uri), uri->imitation, std::nullopt);
  EXPECT_EQ(recording.num_color_frames(), 0);
  EXPECT_GT(recording.num_depth_frames(), 0);
}

TEST(GroundTruth, CameraIsThatOfTheSensor) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("kintsugi_camera_" + std::to_string(getpid()));
  const mapper::SyntheticRecording recording(Sequence::Config::parse(
      "box-room", {{"frames", "2"}, {"sensor", "lidar"}, {"ground_truth", folder.string()}}));
  std::ifstream camera(folder / "camera.txt");
  std::string line;
  std::getline(camera, line);  // a comment
  std::getline(camera, line);
  EXPECT_EQ(line, "212 212 127.5 95.5 256 192 1000");
  std::filesystem::remove_all(folder);
}

TEST(GroundTruth, IsWrittenWhenASyntheticDeviceIsOpenedWithAFolderForIt) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("kintsugi_truth_" + std::to_string(getpid()));
  const auto config = Sequence::Config::parse(
      "box-room", {{"frames", "4"}, {"start", "1"}, {"ground_truth", folder.string()}});
  const mapper::SyntheticRecording recording(config);
  const Sequence sequence(config);

  std::ifstream poses(folder / "groundtruth.txt");
  std::string line;
  int frame = 0;
  while (std::getline(poses, line)) {
    if (line.starts_with('#')) continue;
    std::istringstream words(line);
    std::string time;
    double x, y, z, qx, qy, qz, qw;
    ASSERT_TRUE(words >> time >> x >> y >> z >> qx >> qy >> qz >> qw) << line;
    if (frame == 0) {
      EXPECT_EQ(time, "0.033333");
    }
    const Pose X_WC = sequence.X_WC(frame++);
    EXPECT_NEAR((X_WC.translation() - Eigen::Vector3d(x, y, z)).norm(), 0.0, 2e-9);
    EXPECT_LT(Eigen::Quaterniond(qw, qx, qy, qz).angularDistance(Eigen::Quaterniond(X_WC.linear())),
              1e-7);
  }
  EXPECT_EQ(frame, 4);

  const auto json = nlohmann::json::parse(std::ifstream(folder / "instances.json"));
  ASSERT_EQ(json.at("instances").size(), sequence.scene().instances().size());
  EXPECT_EQ(json["instances"][9]["name"], "ball");
  EXPECT_EQ(json["instances"][9]["shape"], "sphere");
  EXPECT_EQ(json["instances"][9]["id"], 10);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace kintsugi::synthetic
