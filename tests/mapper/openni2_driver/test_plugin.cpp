// The driver plugin through the system's own OpenNI2 library, as an ordinary client sees it.

#include <cmath>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/openni2_driver/recording/device_properties.hpp"
#include "tests/mapper/openni2_driver/openni2_client.hpp"
#include "tests/mapper/openni2_driver/recording_folder.hpp"

namespace kintsugi::mapper {
namespace {

using test::Client;
using test::kNumFrames;
using test::OpenNi2Session;
using test::RecordingFolder;
using testing::HasSubstr;

bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0.0;
}

TEST(Plugin, DescribesTheRecording) {
  const OpenNi2Session session;
  ASSERT_EQ(session.status(), openni::STATUS_OK) << openni::OpenNI::getExtendedError();
  const RecordingFolder folder;
  Client client(folder.uri());
  ASSERT_TRUE(client.is_open()) << client.error();

  EXPECT_EQ(client.device().getDeviceInfo().getName(), folder.path().filename().string());
  EXPECT_TRUE(client.device().isFile());
  const openni::VideoMode mode = client.depth().getVideoMode();
  EXPECT_EQ(mode.getResolutionX(), 64);
  EXPECT_EQ(mode.getResolutionY(), 48);
  EXPECT_EQ(mode.getFps(), 30);
  EXPECT_EQ(mode.getPixelFormat(), openni::PIXEL_FORMAT_DEPTH_1_MM);
  EXPECT_EQ(client.color().getVideoMode().getPixelFormat(), openni::PIXEL_FORMAT_RGB888);
  EXPECT_FLOAT_EQ(client.depth().getHorizontalFieldOfView(),
                  static_cast<float>(2.0 * std::atan(32.0 / 50.0)));
  EXPECT_FLOAT_EQ(client.depth().getVerticalFieldOfView(),
                  static_cast<float>(2.0 * std::atan(24.0 / 51.0)));
  EXPECT_EQ(client.depth().getMaxPixelValue(), 32767);
  EXPECT_EQ(client.device().getPlaybackControl()->getNumberOfFrames(client.depth()), kNumFrames);
  EXPECT_EQ(client.device().getPlaybackControl()->getNumberOfFrames(client.color()), kNumFrames);
  EXPECT_TRUE(
      client.device().isImageRegistrationModeSupported(openni::IMAGE_REGISTRATION_DEPTH_TO_COLOR));
  EXPECT_EQ(client.device().setImageRegistrationMode(openni::IMAGE_REGISTRATION_DEPTH_TO_COLOR),
            openni::STATUS_OK);
}

TEST(Plugin, TellsTheWholeCalibration) {
  const OpenNi2Session session;
  const RecordingFolder folder("50 51 30.5 22.5 64 48 1000 0.1 -0.2 0.01 0.02 0.3\n");
  Client client(folder.uri());
  ASSERT_TRUE(client.device().isPropertySupported(kDevicePropertyCalibration));
  DeviceCalibration calibration{};
  int size = sizeof(calibration);
  ASSERT_EQ(client.device().getProperty(kDevicePropertyCalibration, &calibration, &size),
            openni::STATUS_OK);
  EXPECT_EQ(calibration.cx, 30.5);
  EXPECT_EQ(calibration.cy, 22.5);
  EXPECT_EQ(calibration.width, 64);
  EXPECT_THAT(calibration.distortion, testing::ElementsAre(0.1, -0.2, 0.01, 0.02, 0.3));
}

TEST(Plugin, DeliversEveryFrameToASlowReaderAtSpeedMinusOne) {
  const OpenNi2Session session;
  const RecordingFolder folder;
  Client client(folder.uri());
  client.start(-1.0F);
  for (std::size_t n = 1; n <= kNumFrames; ++n) {
    client.read_all(2000, n);
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
  }
  client.read_all();

  ASSERT_EQ(client.depth_frames.size(), kNumFrames);
  ASSERT_EQ(client.color_frames.size(), kNumFrames);
  for (int i = 0; i < kNumFrames; ++i) {
    const auto n = static_cast<std::size_t>(i);
    EXPECT_EQ(client.depth_frames[n].index, i + 1);
    EXPECT_EQ(client.depth_frames[n].utime, RecordingFolder::depth_utime(i));
    EXPECT_EQ(client.color_frames[n].utime, RecordingFolder::color_utime(i));
    EXPECT_TRUE(same(client.depth_frames[n].image, test::raw_depth_image(i))) << i;
    EXPECT_TRUE(same(client.color_frames[n].image, test::color_image(i))) << i;
  }
  EXPECT_EQ(session.device_state(), openni::DEVICE_STATE_EOF);
}

TEST(Plugin, RepeatsWithAscendingTimesAndNumbers) {
  const OpenNi2Session session;
  const RecordingFolder folder;
  Client client(folder.uri());
  client.start(-1.0F, true);
  client.read_all(2000, 2 * kNumFrames + 1);
  ASSERT_EQ(client.depth_frames.size(), 2 * kNumFrames + 1);
  for (std::size_t i = 1; i < client.depth_frames.size(); ++i) {
    EXPECT_EQ(client.depth_frames[i].index, client.depth_frames[i - 1].index + 1);
    EXPECT_GT(client.depth_frames[i].utime, client.depth_frames[i - 1].utime);
  }
  EXPECT_TRUE(same(client.depth_frames[kNumFrames].image, test::raw_depth_image(0)));
  EXPECT_EQ(session.device_state(), openni::DEVICE_STATE_OK);
}

TEST(Plugin, PlaysAtItsOwnPaceAtSpeedOne) {
  const OpenNi2Session session;
  const RecordingFolder folder;
  Client client(folder.uri());
  const auto begin = std::chrono::steady_clock::now();
  client.start(1.0F);
  client.read_all(2000, kNumFrames);
  const auto elapsed = std::chrono::steady_clock::now() - begin;
  // Only a lower bound: a busy machine may be slower, and a reader that is late loses frames.
  EXPECT_GE(elapsed, std::chrono::milliseconds(4 * 33 - 5));
}

TEST(Plugin, StartsAnewAfterTheEnd) {
  const OpenNi2Session session;
  const RecordingFolder folder;
  Client client(folder.uri());
  client.start(-1.0F);
  client.read_all();
  client.depth().stop();
  client.color().stop();
  client.start(-1.0F);
  client.read_all();
  EXPECT_EQ(client.depth_frames.size(), 2 * kNumFrames);
  EXPECT_EQ(client.depth_frames.back().index, kNumFrames);
}

TEST(Plugin, OffersFinerDepthAsASecondMode) {
  const OpenNi2Session session;
  const RecordingFolder folder("50 51 31.5 23.5 64 48 5000\n");
  Client client(folder.uri());
  ASSERT_EQ(client.depth().getSensorInfo().getSupportedVideoModes().getSize(), 2);
  openni::VideoMode mode = client.depth().getVideoMode();
  mode.setPixelFormat(openni::PIXEL_FORMAT_DEPTH_100_UM);
  ASSERT_EQ(client.depth().setVideoMode(mode), openni::STATUS_OK);
  client.start(-1.0F);
  client.read_all(2000, 1);
  cv::Mat expected = test::raw_depth_image(0) * 2;  // 0.2 mm to 0.1 mm
  EXPECT_TRUE(same(client.depth_frames.at(0).image, expected));

  mode.setResolution(320, 240);
  EXPECT_NE(client.depth().setVideoMode(mode), openni::STATUS_OK);
}

TEST(Plugin, MirrorsAndCrops) {
  const OpenNi2Session session;
  const RecordingFolder folder;
  Client client(folder.uri());
  ASSERT_EQ(client.depth().setMirroringEnabled(true), openni::STATUS_OK);
  ASSERT_EQ(client.depth().setCropping(8, 4, 32, 16), openni::STATUS_OK);
  EXPECT_NE(client.color().setCropping(40, 0, 32, 16), openni::STATUS_OK) << "beyond the image";
  EXPECT_NE(client.color().setCropping(-1, 0, 32, 16), openni::STATUS_OK);
  client.start(-1.0F);
  client.read_all(2000, 1);
  cv::Mat mirrored;
  cv::flip(test::raw_depth_image(0), mirrored, 1);
  EXPECT_TRUE(same(client.depth_frames.at(0).image, mirrored(cv::Rect(8, 4, 32, 16))));
}

TEST(Plugin, PlaysDepthAlone) {
  const OpenNi2Session session;
  const RecordingFolder folder;
  std::filesystem::remove(folder.path() / "rgb.txt");
  Client client(folder.uri());
  EXPECT_FALSE(client.device().hasSensor(openni::SENSOR_COLOR));
  client.start(-1.0F);
  client.read_all();
  EXPECT_EQ(client.depth_frames.size(), kNumFrames);
}

TEST(Plugin, SaysWhyADeviceCannotBeOpened) {
  const OpenNi2Session session;
  const RecordingFolder folder;
  test::write_text(folder.path() / "camera.txt", "50 51 31.5 23.5 64 48\n");
  EXPECT_THAT(Client(folder.uri()).error(), HasSubstr("camera.txt:1: 6 fields"));
  EXPECT_THAT(Client("folder:///no/such/folder").error(), HasSubstr("no such file or folder"));
  EXPECT_THAT(Client("synthetic://no-such-room").error(), HasSubstr("no-such-room"));
  EXPECT_THAT(Client("folder://" + std::string(300, 'x')).error(), HasSubstr("longer than"));
  test::write_text(folder.path() / "camera.txt", "50 51 31.5 23.5 64 48 1000\n");
  EXPECT_TRUE(Client(folder.uri()).is_open()) << "once it is mended";
}

template <typename Value>
Value property_of(Client& client, int property) {
  Value value{};
  int size = sizeof(value);
  EXPECT_EQ(client.device().getProperty(property, &value, &size), openni::STATUS_OK);
  return value;
}

std::vector<int> indices_of(const std::vector<test::ClientFrame>& frames) {
  std::vector<int> indices;
  for (const test::ClientFrame& frame : frames) indices.push_back(frame.index);
  return indices;
}

TEST(Plugin, PassesOverAndCountsImagesThatCannotBeRead) {
  const OpenNi2Session session;
  const RecordingFolder folder;
  std::filesystem::remove(folder.path() / "depth/0.png");
  std::filesystem::resize_file(folder.path() / "depth/3.png", 40);
  std::filesystem::resize_file(folder.path() / "rgb/4.png", 0);
  Client client(folder.uri());
  client.start(-1.0F);
  client.read_all();
  EXPECT_THAT(indices_of(client.depth_frames), testing::ElementsAre(2, 3, 5));
  EXPECT_THAT(indices_of(client.color_frames), testing::ElementsAre(1, 2, 3, 4));
  EXPECT_TRUE(same(client.depth_frames.at(2).image, test::raw_depth_image(4)));
  EXPECT_EQ(session.device_state(), openni::DEVICE_STATE_EOF);
  const auto unread = property_of<UnreadImages>(client, kDevicePropertyUnreadImages);
  EXPECT_EQ(unread.depth, 2);
  EXPECT_EQ(unread.color, 1);
  EXPECT_THAT(unread.last_reason, HasSubstr("rgb/4.png: is empty"));
}

TEST(Plugin, FailsWhenNoDepthImageCanBeRead) {
  const OpenNi2Session session;
  const RecordingFolder folder;
  std::filesystem::remove_all(folder.path() / "depth");
  for (const bool repeat : {false, true}) {
    Client client(folder.uri());
    client.start(-1.0F, repeat);
    client.read_all();
    EXPECT_EQ(client.depth_frames.size(), 0);
    EXPECT_EQ(session.device_state(), openni::DEVICE_STATE_ERROR);
    const auto text = property_of<std::array<char, 256>>(client, kDevicePropertyPlaybackError);
    EXPECT_THAT(text.data(), HasSubstr("no depth image of the recording can be read; the first: "));
    EXPECT_THAT(text.data(), HasSubstr("depth/0.png: cannot be read"));
  }
}

TEST(Plugin, PlaysColorAloneWhileDepthIsNotStarted) {
  const OpenNi2Session session;
  const RecordingFolder folder;
  std::filesystem::remove_all(folder.path() / "depth");
  Client client(folder.uri());
  client.device().getPlaybackControl()->setSpeed(-1.0F);
  client.device().getPlaybackControl()->setRepeatEnabled(false);
  client.color().start();
  client.read_all();
  EXPECT_EQ(client.color_frames.size(), kNumFrames);
  EXPECT_EQ(session.device_state(), openni::DEVICE_STATE_EOF);
}

TEST(Plugin, TellsThatTimesAreFrameNumbers) {
  const OpenNi2Session session;
  const RecordingFolder folder;
  {
    Client seconds(folder.uri());
    EXPECT_STREQ((property_of<std::array<char, 256>>(seconds, kDevicePropertyRemark).data()), "");
  }
  std::filesystem::remove(folder.path() / "rgb.txt");
  test::write_text(folder.path() / "depth.txt", "0 depth/0.png\n1 depth/1.png\n2 depth/2.png\n");
  Client client(folder.uri());
  EXPECT_THAT((property_of<std::array<char, 256>>(client, kDevicePropertyRemark).data()),
              HasSubstr("frame numbers"));
  client.start(-1.0F);
  client.read_all();
  ASSERT_EQ(client.depth_frames.size(), 3);
  EXPECT_EQ(client.depth_frames.back().utime, 66'667);
}

TEST(Plugin, LeavesRowsOfACameraWhoseYPointsUpAsTheyAre) {
  const OpenNi2Session session;
  const RecordingFolder folder("50 -51 31.5 20.5 64 48 1000\n");
  Client client(folder.uri());
  EXPECT_FLOAT_EQ(client.depth().getVerticalFieldOfView(),
                  static_cast<float>(2.0 * std::atan(24.0 / 51.0)));
  const auto calibration = property_of<DeviceCalibration>(client, kDevicePropertyCalibration);
  EXPECT_EQ(calibration.fy, -51.0);
  EXPECT_EQ(calibration.cy, 20.5);
  client.start(-1.0F);
  client.read_all(2000, 1);
  EXPECT_TRUE(same(client.depth_frames.at(0).image, test::raw_depth_image(0)));
}

TEST(Plugin, StopsAtAnyMoment) {
  const OpenNi2Session session;
  const RecordingFolder folder;
  for (int round = 0; round < 20; ++round) {
    Client client(folder.uri());
    client.start(0.0F, true);  // as fast as it can
    client.read_all(2000, static_cast<std::size_t>(round % 4));
  }
}

TEST(Plugin, RefusesToSeek) {
  const OpenNi2Session session;
  const RecordingFolder folder;
  Client client(folder.uri());
  EXPECT_NE(client.device().invoke(openni::DEVICE_COMMAND_SEEK + 1, nullptr, 0), openni::STATUS_OK);
  client.start(-1.0F);
  client.read_all();
  EXPECT_EQ(client.depth_frames.size(), kNumFrames);
}

}  // namespace
}  // namespace kintsugi::mapper
