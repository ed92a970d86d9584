// Recordings of iPhones: Stray Scanner and Record3D.

#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/videoio.hpp>

#include "tests/mapper/openni2_driver/formats/written_recordings.hpp"

namespace kintsugi::mapper {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using test::open_recording_at;
using test::same;
using ::testing::AllOf;
using ::testing::HasSubstr;

class StrayScannerFolder : public ::testing::Test {
 protected:
  StrayScannerFolder() {
    fs::create_directories(folder_ / "depth");
    fs::create_directories(folder_ / "confidence");
    std::string odometry = "timestamp, frame, x, y, z, qx, qy, qz, qw\n";
    for (int frame = 0; frame < kNumFrames; ++frame) {
      const std::string name = "00000" + std::to_string(frame) + ".png";
      cv::imwrite((folder_ / ("depth/" + name)).string(), test::raw_depth_image(frame));
      cv::Mat_<std::uint8_t> confidence(test::kHeight, test::kWidth, std::uint8_t{2});
      confidence(4, 7) = 0;
      confidence(4, 8) = 1;
      cv::imwrite((folder_ / ("confidence/" + name)).string(), confidence);
      odometry += "1000." + std::to_string(100 + 16 * frame) + ", 00000" + std::to_string(frame) +
                  ", 0.0, 0.0, " + std::to_string(frame) + ", 0.0, 0.0, 0.0, 1.0\n";
    }
    test::write_text(folder_ / "odometry.csv", odometry);
    test::write_text(folder_ / "camera_matrix.csv",
                     "200.0,0.0,127.5\n0.0,200.0,95.5\n0.0,0.0,1.0\n");
  }

  /// One colour for each picture: what a video keeps best.
  void write_video() {
    const cv::Size size(4 * test::kWidth, 4 * test::kHeight);
    cv::VideoWriter video((folder_ / "rgb.mp4").string(),
                          cv::VideoWriter::fourcc('m', 'p', '4', 'v'), 60.0, size);
    ASSERT_TRUE(video.isOpened());
    for (int frame = 0; frame < kNumFrames; ++frame) {
      video.write(cv::Mat(size, CV_8UC3, cv::Scalar(200, 100, 20 + 40 * frame)));
    }
  }

  static constexpr int kNumFrames = 4;
  kintsugi::testing::TemporaryFolder folder_;
};

TEST_F(StrayScannerFolder, DepthTimesAndPosesComeBack) {
  FileRecording recording = open_recording_at(folder_.path());
  ASSERT_EQ(recording.num_depth_frames(), kNumFrames);
  EXPECT_EQ(recording.depth_utime(1), 1'000'116'000);
  EXPECT_EQ(recording.depth_X_WC(3).value().translation().z(), 3.0);
  EXPECT_EQ(recording.num_color_frames(), 0);
  EXPECT_THAT(recording.remark(), HasSubstr("no rgb.mp4"));
}

TEST_F(StrayScannerFolder, DepthThatIsAGuessIsInvalid) {
  FileRecording recording = open_recording_at(folder_.path());
  cv::Mat_<std::uint16_t> expected = test::raw_depth_image(1);
  ASSERT_NE(expected(4, 7), 0);
  expected(4, 7) = 0;  // its confidence is 0; that beside it is 1
  EXPECT_TRUE(same(recording.depth(1, DepthUnit::k1mm), expected));
}

TEST_F(StrayScannerFolder, PicturesOfTheVideoAreColourInAnyOrder) {
  write_video();
  FileRecording recording = open_recording_at(folder_.path());
  ASSERT_EQ(recording.num_color_frames(), kNumFrames);
  EXPECT_NEAR(recording.intrinsics().fx, 50.0, 1e-9) << "a quarter of the video's";
  for (const int frame : {3, 0, 2, 2}) {
    const cv::Mat_<cv::Vec3b> color = recording.color(frame);
    ASSERT_EQ(color.size(), cv::Size(test::kWidth, test::kHeight));
    EXPECT_NEAR(color(24, 32)[0], 20 + 40 * frame, 8) << "red of picture " << frame;
    EXPECT_NEAR(color(24, 32)[2], 200, 8);
  }
}

TEST_F(StrayScannerFolder, AVideoThatIsNoneLeavesDepth) {
  test::write_text(folder_ / "rgb.mp4", "not a video");
  const FileRecording recording = open_recording_at(folder_.path());
  EXPECT_EQ(recording.num_color_frames(), 0);
  EXPECT_THAT(recording.remark(), AllOf(HasSubstr("no colour"), HasSubstr("rgb.mp4")));
}

TEST_F(StrayScannerFolder, ABadLineIsNamed) {
  test::write_text(folder_ / "odometry.csv", "timestamp, frame\n1.0, 0\n");
  EXPECT_THAT(error_of<std::runtime_error>([&] { (void)open_recording_at(folder_.path()); }),
              AllOf(HasSubstr("odometry.csv:2: "), HasSubstr("qw")));
}

void write_exr(const fs::path& file, cv::Mat_<float> depth_m, const char* channel = "R") {
  Imf::Header header(depth_m.cols, depth_m.rows);
  header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
  Imf::FrameBuffer buffer;
  buffer.insert(channel, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(depth_m.data),
                                    sizeof(float), depth_m.step[0]));
  Imf::OutputFile out(file.c_str(), header);
  out.setFrameBuffer(buffer);
  out.writePixels(depth_m.rows);
}

class Record3DFolder : public ::testing::Test {
 protected:
  Record3DFolder() {
    fs::create_directories(folder_ / "depth");
    fs::create_directories(folder_ / "rgb");
    for (int frame = 0; frame < 2; ++frame) {
      cv::Mat_<float> depth_m(12, 16, 1.25F);
      depth_m(3, 4) = 2.00004F;
      depth_m(3, 5) = 0.0F;
      depth_m(3, 6) = std::numeric_limits<float>::quiet_NaN();
      depth_m(3, 7) = 9.0F;  // beyond what 0.1 mm can hold in 16 bits
      write_exr(folder_ / ("depth/" + std::to_string(frame) + ".exr"), depth_m);
      test::write_color(folder_ / ("rgb/" + std::to_string(frame) + ".png"),
                        test::color_image(frame));
    }
    test::write_text(folder_ / "metadata.json",
                     R"({"K": [60, 0, 0, 0, 60, 0, 31.5, 23.5, 1], "w": 64, "h": 48, "fps": 60,
                         "frameTimestamps": [0.5, 0.516668],
                         "poses": [[0, 0, 0, 1, 1, 2, 3], [0.7071068, 0, 0, 0.7071068, 0, 0, 0]]})");
  }

  kintsugi::testing::TemporaryFolder folder_;
};

TEST_F(Record3DFolder, MetresBecomeUnitsOfATenthOfAMillimetre) {
  FileRecording recording = open_recording_at(folder_.path());
  EXPECT_EQ(recording.finest_depth_unit(), DepthUnit::k100um);
  const auto depth = recording.depth(0, DepthUnit::k100um);
  EXPECT_EQ(depth(0, 0), 12500);
  EXPECT_EQ(depth(3, 4), 20000);
  EXPECT_EQ(depth(3, 5), 0);
  EXPECT_EQ(depth(3, 6), 0);
  EXPECT_EQ(depth(3, 7), 0);
  EXPECT_EQ(recording.depth(0, DepthUnit::k1mm)(3, 7), 9000);
}

TEST_F(Record3DFolder, TheCameraIsThatOfTheColourImagesAtTheSizeOfDepth) {
  FileRecording recording = open_recording_at(folder_.path());
  EXPECT_DOUBLE_EQ(recording.intrinsics().fx, 15.0);
  EXPECT_DOUBLE_EQ(recording.intrinsics().cx, (31.5 + 0.5) / 4.0 - 0.5);
  EXPECT_EQ(recording.color(1).size(), cv::Size(16, 12));
  EXPECT_EQ(recording.depth_utime(1), 516'668);
}

TEST_F(Record3DFolder, PosesOfARKitLookTheOtherWay) {
  const FileRecording recording = open_recording_at(folder_.path());
  // ARKit's camera looks along -z and has y up: ours, in the same place, looks along +z.
  const Pose X_WC = recording.depth_X_WC(0).value();
  EXPECT_TRUE(X_WC.translation().isApprox(Eigen::Vector3d(1, 2, 3)));
  EXPECT_TRUE((X_WC.linear() * Eigen::Vector3d::UnitZ()).isApprox(-Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE((X_WC.linear() * Eigen::Vector3d::UnitY()).isApprox(-Eigen::Vector3d::UnitY()));
  // The second is turned by 90 degrees about x: what was -z is now +y.
  EXPECT_TRUE((recording.depth_X_WC(1).value().linear() * Eigen::Vector3d::UnitZ())
                  .isApprox(Eigen::Vector3d::UnitY(), 1e-6));
}

TEST_F(Record3DFolder, AnImageThatIsNoneIsNamedWhenItIsRead) {
  test::write_text(folder_ / "depth/1.exr", "v/1\x01 nothing more");
  FileRecording recording = open_recording_at(folder_.path());
  EXPECT_THAT(error_of<std::runtime_error>([&] { (void)recording.depth(1, DepthUnit::k1mm); }),
              HasSubstr("depth/1.exr"));
  EXPECT_EQ(recording.depth(0, DepthUnit::k1mm)(0, 0), 1250);
}

TEST_F(Record3DFolder, MetadataWithoutACameraIsRefused) {
  test::write_text(folder_ / "metadata.json", R"({"w": 64, "h": 48})");
  EXPECT_THAT(error_of<std::runtime_error>([&] { (void)open_recording_at(folder_.path()); }),
              AllOf(HasSubstr("metadata.json"), HasSubstr("K")));
}

}  // namespace
}  // namespace kintsugi::mapper
