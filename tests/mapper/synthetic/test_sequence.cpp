#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

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
  const auto config = Sequence::Config::parse(
      "loop", {{"noise", "off"}, {"seed", "9"}, {"frames", "30"}, {"start", "12"}});
  EXPECT_EQ(config.scene, "loop");
  EXPECT_FALSE(config.noise);
  EXPECT_EQ(config.seed, 9U);
  EXPECT_EQ(config.frames, 30);
  EXPECT_EQ(config.start, 12);
  EXPECT_THAT(error_of({{"nose", "off"}}), HasSubstr("nose"));
  EXPECT_THAT(error_of({{"noise", "maybe"}}), HasSubstr("on or off"));
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
