// What the driver imitates of cameras, as an ordinary OpenNI2 client sees it.

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

std::vector<int> indices_of(const std::vector<test::ClientFrame>& frames) {
  std::vector<int> indices;
  indices.reserve(frames.size());
  for (const auto& frame : frames) indices.push_back(frame.index);
  return indices;
}

TEST(ImitatedCamera, IsNoFileAndHasNoEnd) {
  const OpenNi2Session session;
  const RecordingFolder folder;
  Client client(folder.uri() + "?camera=on");
  ASSERT_TRUE(client.is_open()) << client.error();
  EXPECT_FALSE(client.device().isFile());
  client.depth().start();
  client.read_all(2000, kNumFrames + 2);  // at its own pace
  EXPECT_GE(client.depth_frames.size(), kNumFrames + 2U);
  EXPECT_EQ(session.device_state(), openni::DEVICE_STATE_OK);
}

TEST(ImitatedCamera, OffersTheModesItIsTold) {
  const OpenNi2Session session;
  const RecordingFolder folder;
  Client client(folder.uri() +
                "?depth_modes=64x48@30,32x24@15&depth_units=1mm,100um&color_modes=128x102@30");
  ASSERT_TRUE(client.is_open()) << client.error();
  const auto& modes = client.depth().getSensorInfo().getSupportedVideoModes();
  ASSERT_EQ(modes.getSize(), 4);
  ASSERT_EQ(client.depth().setVideoMode(modes[2]), openni::STATUS_OK);
  DeviceCalibration calibration{};
  int size = sizeof(calibration);
  ASSERT_EQ(client.device().getProperty(kDevicePropertyCalibration, &calibration, &size),
            openni::STATUS_OK);
  EXPECT_EQ(calibration.width, 32);
  EXPECT_EQ(calibration.fx, 25.0);
  EXPECT_EQ(calibration.cx, 15.5) << "the middle stays the middle";
  client.start(-1.0F);
  client.read_all();
  ASSERT_EQ(client.depth_frames.size(), 3U) << "every second of 30 Hz";
  EXPECT_THAT(indices_of(client.depth_frames), testing::ElementsAre(1, 2, 3));
  EXPECT_EQ(client.depth_frames[1].utime, RecordingFolder::depth_utime(2));
  EXPECT_EQ(client.depth_frames[0].image.size(), cv::Size(32, 24));
  const cv::Mat& color = client.color_frames.at(0).image;
  ASSERT_EQ(color.size(), cv::Size(128, 102));
  EXPECT_EQ(color.at<cv::Vec3b>(95, 100), test::color_rgb(0, 50, 47));
  EXPECT_EQ(color.at<cv::Vec3b>(96, 100), cv::Vec3b(255, 0, 255)) << "below what depth sees";
}

TEST(ImitatedCamera, MirrorsForGood) {
  const OpenNi2Session session;
  const RecordingFolder folder;
  Client client(folder.uri() + "?mirror=stuck");
  EXPECT_TRUE(client.depth().getMirroringEnabled());
  EXPECT_NE(client.depth().setMirroringEnabled(false), openni::STATUS_OK);
  EXPECT_TRUE(client.depth().getMirroringEnabled());
}

TEST(ImitatedCamera, SeesWithTwoEyesUntilRegistered) {
  const OpenNi2Session session;
  const RecordingFolder folder;
  const auto first_depth = [&](bool registered) {
    Client client(folder.uri() + "?registration=switchable");
    EXPECT_EQ(client.device().getImageRegistrationMode(), openni::IMAGE_REGISTRATION_OFF);
    if (registered) {
      client.device().setImageRegistrationMode(openni::IMAGE_REGISTRATION_DEPTH_TO_COLOR);
    }
    client.start(-1.0F);
    client.read_all(2000, 1);
    return client.depth_frames.at(0).image;
  };
  EXPECT_EQ(first_depth(true).at<std::uint16_t>(5, 9), test::raw_depth(0, 9, 5));
  EXPECT_EQ(first_depth(false).at<std::uint16_t>(5, 9 + 3), test::raw_depth(0, 9, 5));
}

TEST(ImitatedCamera, ChangesExposureUntilItIsTurnedOff) {
  const OpenNi2Session session;
  const RecordingFolder folder;
  Client client(folder.uri() + "?exposure=on");
  openni::CameraSettings* settings = client.color().getCameraSettings();
  ASSERT_NE(settings, nullptr);
  EXPECT_TRUE(settings->getAutoExposureEnabled());
  client.start(-1.0F);
  client.read_all();
  const int before = settings->getExposure();
  EXPECT_NE(before, 100);
  settings->setAutoExposureEnabled(false);
  settings->setAutoWhiteBalanceEnabled(false);
  client.depth().stop();
  client.color().stop();
  client.start(-1.0F);
  client.read_all();
  EXPECT_EQ(settings->getExposure(), before);
  const auto& images = client.color_frames;
  ASSERT_EQ(images.size(), 2U * kNumFrames);
  const auto at = [&](std::size_t i) { return images[i].image.at<cv::Vec3b>(20, 30); };
  EXPECT_EQ(at(kNumFrames)[1], at(kNumFrames + 4)[1]) << "green does not depend on the frame";
  EXPECT_EQ(at(kNumFrames)[0], at(kNumFrames + 4)[0]);
}

TEST(ImitatedCamera, LosesColourImages) {
  const OpenNi2Session session;
  const RecordingFolder folder;
  Client client(folder.uri() + "?color_gap=2-4&color_clock_ms=5000");
  client.start(-1.0F);
  client.read_all();
  EXPECT_EQ(client.depth_frames.size(), kNumFrames);
  ASSERT_EQ(client.color_frames.size(), 2U);
  EXPECT_EQ(client.color_frames[1].utime, RecordingFolder::color_utime(4) + 5'000'000);
}

TEST(ImitatedCamera, GoesAwayAndComesBack) {
  const RecordingFolder folder;
  const std::string uri =
      folder.uri() + "?unplug_at=2&replug_after_ms=40&restart_clock=on&color=off";
  {
    const OpenNi2Session session;
    Client client(uri);
    client.start(-1.0F);
    client.read_all(100);
    EXPECT_EQ(client.depth_frames.size(), 2U);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(60));
  const OpenNi2Session session;
  Client client(uri);
  ASSERT_TRUE(client.is_open()) << client.error();
  client.start(-1.0F);
  client.read_all();
  ASSERT_EQ(client.depth_frames.size(), 1U) << "the others passed meanwhile";
  EXPECT_EQ(client.depth_frames[0].utime, 0);
  EXPECT_EQ(client.depth_frames[0].index, 1);
  cv::Mat difference;
  cv::absdiff(client.depth_frames[0].image, test::raw_depth_image(4), difference);
  EXPECT_EQ(cv::countNonZero(difference), 0);
}

TEST(ImitatedCamera, StaysAwayUntilItsTime) {
  const RecordingFolder folder;
  const std::string uri = folder.uri() + "?unplug_at=1";
  {
    const OpenNi2Session session;
    Client client(uri);
    client.start(-1.0F);
    client.read_all(100);
  }
  const OpenNi2Session session;
  EXPECT_THAT(Client(uri).error(), HasSubstr("is not plugged in"));
}

}  // namespace
}  // namespace kintsugi::mapper
