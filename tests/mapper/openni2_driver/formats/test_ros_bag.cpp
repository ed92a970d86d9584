#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>

#include "mapper/openni2_driver/formats/ros_messages.hpp"
#include "mapper/openni2_driver/formats/ros_topics.hpp"
#include "tests/mapper/openni2_driver/formats/written_recordings.hpp"

namespace kintsugi::mapper {
namespace {

namespace fs = std::filesystem;
using ros1::CameraInfo;
using ros1::CompressedImage;
using ros1::Image;
using test::error_of;
using test::open_recording_at;
using test::same;
using ::testing::AllOf;
using ::testing::HasSubstr;

ros::Time time_of(int frame) {
  return ros::Time(1000).fromNSec(
      1000UL * static_cast<std::uint64_t>(test::RecordingFolder::depth_utime(frame)));
}

Image image_of(const cv::Mat& pixels, const char* encoding, int frame, const char* frame_id) {
  Image image;
  image.header.stamp = time_of(frame);
  image.header.frame_id = frame_id;
  image.width = static_cast<std::uint32_t>(pixels.cols);
  image.height = static_cast<std::uint32_t>(pixels.rows);
  image.encoding = encoding;
  image.step = static_cast<std::uint32_t>(pixels.cols * pixels.elemSize());
  const auto bytes = test::raw_bytes(pixels);
  image.data.assign(bytes.begin(), bytes.end());
  return image;
}

CameraInfo camera(double f, int width, int height) {
  CameraInfo info;
  info.width = static_cast<std::uint32_t>(width);
  info.height = static_cast<std::uint32_t>(height);
  info.distortion_model = "plumb_bob";
  info.D.resize(5, 0.0);
  info.K[0] = f;
  info.K[2] = 0.5 * (width - 1);
  info.K[4] = f;
  info.K[5] = 0.5 * (height - 1);
  info.K[8] = 1.0;
  return info;
}

class RosBag : public ::testing::Test {
 protected:
  RosBag() { bag_.open(file_.string(), rosbag::bagmode::Write); }

  template <typename Message>
  void write(const std::string& topic, int frame, const Message& message) {
    // As rosbag records it: some milliseconds after it was taken.
    bag_.write(topic, time_of(frame) + ros::Duration(0.004 + 0.003 * (frame % 3)), message);
  }

  void write_registered(int num_frames, const char* color_encoding = "rgb8") {
    for (int frame = 0; frame < num_frames; ++frame) {
      write("/camera/depth_registered/image_raw", frame,
            image_of(test::raw_depth_image(frame), "16UC1", frame, "color_optical"));
      write("/camera/depth_registered/camera_info", frame,
            camera(50.0, test::kWidth, test::kHeight));
      write("/camera/rgb/image_raw", frame,
            image_of(test::color_image(frame), color_encoding, frame, "color_optical"));
      write("/camera/rgb/camera_info", frame, camera(50.0, test::kWidth, test::kHeight));
    }
  }

  [[nodiscard]] FileRecording open(const ReadingOptions& options = {}) {
    bag_.close();
    return open_recording_at(file_, options);
  }

  kintsugi::testing::TemporaryFolder folder_;
  fs::path file_ = folder_ / "walk.bag";
  rosbag::Bag bag_;
};

TEST_F(RosBag, ImagesHaveTheTimesAtWhichTheyWereTaken) {
  write_registered(3);
  FileRecording recording = open();
  ASSERT_EQ(recording.num_depth_frames(), 3);
  ASSERT_EQ(recording.num_color_frames(), 3);
  EXPECT_EQ(recording.intrinsics().fx, 50.0);
  for (const int frame : {2, 0, 1}) {
    EXPECT_EQ(recording.depth_utime(frame), test::RecordingFolder::depth_utime(frame));
    EXPECT_TRUE(same(recording.depth(frame, DepthUnit::k1mm), test::raw_depth_image(frame)));
    EXPECT_TRUE(same(recording.color(frame), test::color_image(frame)));
  }
  EXPECT_THAT(recording.remark(), AllOf(HasSubstr("/camera/depth_registered/image_raw"),
                                        HasSubstr("/camera/rgb/image_raw")));
}

TEST_F(RosBag, BlueFirstIsTurnedRound) {
  write_registered(1, "bgr8");
  const cv::Vec3b stored = test::color_image(0)(9, 11);
  EXPECT_EQ(open().color(0)(9, 11), cv::Vec3b(stored[2], stored[1], stored[0]));
}

TEST_F(RosBag, CompressedBagsAreRead) {
  bag_.setCompression(rosbag::compression::LZ4);
  write_registered(2);
  EXPECT_TRUE(same(open().depth(1, DepthUnit::k1mm), test::raw_depth_image(1)));
}

TEST_F(RosBag, FloatingPointIsMetres) {
  cv::Mat_<float> depth_m(test::kHeight, test::kWidth, 1.5F);
  depth_m(2, 3) = std::numeric_limits<float>::quiet_NaN();
  write("/depth/image", 0, image_of(depth_m, "32FC1", 0, "depth"));
  write("/depth/camera_info", 0, camera(50.0, test::kWidth, test::kHeight));
  FileRecording recording = open();
  EXPECT_EQ(recording.finest_depth_unit(), DepthUnit::k100um);
  EXPECT_EQ(recording.depth(0, DepthUnit::k100um)(0, 0), 15000);
  EXPECT_EQ(recording.depth(0, DepthUnit::k100um)(2, 3), 0);
  EXPECT_EQ(recording.num_color_frames(), 0);
}

/// @param a, b of inverse depths: value = a / depth + b; 0: millimetres
CompressedImage compressed_depth(const cv::Mat_<std::uint16_t>& values, const char* format, float a,
                                 float b) {
  CompressedImage message;
  message.header.stamp = time_of(0);
  message.format = format;
  std::vector<std::uint8_t> png;
  cv::imencode(".png", values, png);
  message.data.resize(12);
  std::memcpy(message.data.data() + 4, &a, 4);
  std::memcpy(message.data.data() + 8, &b, 4);
  message.data.insert(message.data.end(), png.begin(), png.end());
  return message;
}

TEST_F(RosBag, CompressedDepthIsRead) {
  write("/camera/depth/image_raw/compressedDepth", 0,
        compressed_depth(test::raw_depth_image(0), "16UC1; compressedDepth png", 0.0F, 0.0F));
  write("/camera/depth/camera_info", 0, camera(50.0, test::kWidth, test::kHeight));
  CompressedImage color;
  color.header.stamp = time_of(0);
  color.format = "rgb8; png compressed bgr8";
  const auto png = test::encoded(test::color_image(0), ".png");
  color.data.assign(png.begin(), png.end());
  write("/camera/color/image_raw/compressed", 0, color);
  write("/camera/color/camera_info", 0, camera(50.0, test::kWidth, test::kHeight));
  FileRecording recording = open();
  EXPECT_TRUE(same(recording.depth(0, DepthUnit::k1mm), test::raw_depth_image(0)));
  EXPECT_TRUE(same(recording.color(0), test::color_image(0)));
}

TEST_F(RosBag, InverseDepthsBecomeMetres) {
  cv::Mat_<std::uint16_t> values(test::kHeight, test::kWidth, std::uint16_t{1100});
  values(0, 1) = 0;
  write("/depth/compressedDepth", 0,
        compressed_depth(values, "32FC1; compressedDepth", 2000.0F, 100.0F));
  write("/depth/camera_info", 0, camera(50.0, test::kWidth, test::kHeight));
  const auto depth = open().depth(0, DepthUnit::k1mm);
  EXPECT_EQ(depth(0, 0), 2000) << "2000 / (1100 - 100) m";
  EXPECT_EQ(depth(0, 1), 0);
}

TEST_F(RosBag, AColourCameraBesideIsFoundThroughItsTransforms) {
  write("/cam/depth/image_rect_raw", 0,
        image_of(test::raw_depth_image(0), "16UC1", 0, "depth_optical"));
  write("/cam/depth/camera_info", 0, camera(50.0, test::kWidth, test::kHeight));
  write("/cam/color/image_raw", 0, image_of(test::color_image(0), "rgb8", 0, "color_optical"));
  write("/cam/color/camera_info", 0, camera(50.0, test::kWidth, test::kHeight));
  ros1::TFMessage transforms;
  const auto add = [&](const char* parent, const char* child, double x) {
    ros1::TransformStamped stamped;
    stamped.header.frame_id = parent;
    stamped.child_frame_id = child;
    stamped.transform.translation.x = x;
    stamped.transform.rotation.w = 1.0;
    transforms.transforms.push_back(stamped);
  };
  add("link", "depth_optical", 0.01);
  add("link", "color_optical", 0.06);
  write("/tf_static", 0, transforms);
  FileRecording recording = open();
  const cv::Mat_<std::uint16_t> depth = test::raw_depth_image(0);
  const int y = 20;
  const int x = 40;
  ASSERT_NE(depth(y, x), 0);
  EXPECT_NEAR(recording.color(0)(y, x)[0], 4.0 * (x - 50.0 * 0.05 / (1e-3 * depth(y, x))), 1.5);
}

TEST_F(RosBag, WithoutTransformsItSaysWhereItTakesTheColourCamera) {
  write("/cam/depth/image", 0, image_of(test::raw_depth_image(0), "16UC1", 0, "depth_optical"));
  write("/cam/depth/camera_info", 0, camera(50.0, test::kWidth, test::kHeight));
  write("/cam/color/image", 0, image_of(test::color_image(0), "rgb8", 0, "color_optical"));
  write("/cam/color/camera_info", 0, camera(50.0, test::kWidth, test::kHeight));
  EXPECT_THAT(open().remark(), AllOf(HasSubstr("/tf_static"), HasSubstr("depth_optical")));
}

TEST_F(RosBag, TopicsCanBeChosen) {
  write_registered(1);
  write("/other/depth", 0, image_of(test::raw_depth_image(3), "mono16", 0, "other"));
  write("/other/camera_info", 0, camera(70.0, test::kWidth, test::kHeight));
  FileRecording recording =
      open({.depth_topic = "/other/depth", .color_topic = "", .swap_colors = false});
  EXPECT_TRUE(same(recording.depth(0, DepthUnit::k1mm), test::raw_depth_image(3)));
  EXPECT_EQ(recording.intrinsics().fx, 70.0);
}

TEST_F(RosBag, ATopicThatIsNotThereIsRefusedWithAListOfThoseThatAre) {
  write_registered(1);
  EXPECT_THAT(
      error_of<std::runtime_error>([&] {
        (void)open({.depth_topic = "/nothing", .color_topic = "", .swap_colors = false});
      }),
      AllOf(HasSubstr("walk.bag"), HasSubstr("/nothing"), HasSubstr("/camera/rgb/image_raw")));
}

TEST_F(RosBag, ImagesThatAreNotAsTheirCameraIsAreRefused) {
  write("/depth/image", 0, image_of(test::raw_depth_image(0), "16UC1", 0, "depth"));
  write("/depth/camera_info", 0, camera(50.0, 640, 480));
  EXPECT_THAT(error_of<std::runtime_error>([&] { (void)open(); }),
              AllOf(HasSubstr("64x48"), HasSubstr("640x480")));
}

TEST_F(RosBag, ABagThatWasCutOffIsNamed) {
  write_registered(2);
  bag_.close();
  fs::resize_file(file_, fs::file_size(file_) / 2);
  EXPECT_THAT(error_of<std::runtime_error>([&] { (void)open_recording_at(file_); }),
              AllOf(HasSubstr("walk.bag"), HasSubstr("cut off"), HasSubstr("rosbag reindex")));
}

/// Of an entry, the offset in its chunk.
TEST_F(RosBag, ABagWithADamagedIndexIsRefusedForEveryWrongOffset) {
  write_registered(1);
  bag_.close();
  std::ifstream in(file_, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(in), {}};
  const std::string index = std::string("op=") + char{4};  // the header field of index data
  std::size_t at = bytes.find(index);
  ASSERT_NE(at, std::string::npos);
  at = bytes.find("ver=", at);
  const std::size_t entry = at + 8 + 4;  // behind the version and the length of the data
  for (const std::uint32_t offset : {0x40000000U, 0xffffffffU, 77U}) {
    std::memcpy(bytes.data() + entry + 8, &offset, sizeof offset);
    test::write_text(file_, bytes);
    EXPECT_THAT(error_of<std::runtime_error>([&] { (void)open_recording_at(file_); }),
                AllOf(HasSubstr("walk.bag"), HasSubstr("index is damaged")))
        << offset;
  }
}

TEST_F(RosBag, RegisteredDepthWithoutItsOwnInfoIsSeenAsByTheColourCamera) {
  write("/camera/depth_registered/image_raw", 0,
        image_of(test::raw_depth_image(0), "16UC1", 0, "color_optical"));
  write("/camera/depth/camera_info", 0, camera(57.5, test::kWidth, test::kHeight));
  write("/camera/rgb/image_raw", 0, image_of(test::color_image(0), "rgb8", 0, "color_optical"));
  write("/camera/rgb/camera_info", 0, camera(52.5, test::kWidth, test::kHeight));
  FileRecording recording = open();
  EXPECT_EQ(recording.intrinsics().fx, 52.5);
  EXPECT_TRUE(same(recording.color(0), test::color_image(0)));
  EXPECT_THAT(recording.remark(), HasSubstr("with the camera of /camera/rgb/camera_info"));
}

TEST_F(RosBag, AnUnknownLensModelIsTold) {
  write("/depth/image", 0, image_of(test::raw_depth_image(0), "16UC1", 0, "depth"));
  CameraInfo info = camera(50.0, test::kWidth, test::kHeight);
  info.distortion_model = "rational_polynomial";
  info.D.assign(8, 0.1);
  write("/depth/camera_info", 0, info);
  EXPECT_THAT(open().remark(), HasSubstr("the lens model 'rational_polynomial'"));
}

TEST_F(RosBag, NumbersThatAreNoCamerasAreRefused) {
  write("/depth/image", 0, image_of(test::raw_depth_image(0), "16UC1", 0, "depth"));
  CameraInfo info = camera(50.0, test::kWidth, test::kHeight);
  info.D[0] = std::numeric_limits<double>::quiet_NaN();
  write("/depth/camera_info", 0, info);
  EXPECT_THAT(error_of<std::runtime_error>([&] { (void)open(); }),
              AllOf(HasSubstr("/depth/camera_info"), HasSubstr("is not a camera's")));
}

TEST_F(RosBag, ImagesWithoutTimesHaveThoseAtWhichTheyWereRecorded) {
  write("/depth/camera_info", 0, camera(50.0, test::kWidth, test::kHeight));
  for (int frame = 0; frame < 4; ++frame) {
    Image image = image_of(test::raw_depth_image(frame), "16UC1", frame, "depth");
    image.header.stamp = ros::Time();
    write("/depth/image", frame, image);
  }
  const FileRecording recording = open();
  EXPECT_EQ(recording.num_depth_frames(), 4);
  EXPECT_THAT(recording.remark(), HasSubstr("the headers of /depth/image have no times"));
}

TEST_F(RosBag, ImagesThatAreRepeatedCountOnceHoweverOften) {
  write("/depth/camera_info", 0, camera(50.0, test::kWidth, test::kHeight));
  for (int frame = 0; frame < 9; ++frame) {
    Image image = image_of(test::raw_depth_image(frame / 3), "16UC1", frame / 3, "depth");
    write("/depth/image", frame, image);
  }
  const FileRecording recording = open();
  EXPECT_EQ(recording.num_depth_frames(), 3);
  EXPECT_THAT(recording.remark(), HasSubstr("6 of 9 images of /depth/image are left out"));
}

TEST_F(RosBag, DepthInTwoUnitsIsRefused) {
  write("/depth/camera_info", 0, camera(50.0, test::kWidth, test::kHeight));
  write("/depth/image", 0, image_of(test::raw_depth_image(0), "16UC1", 0, "depth"));
  cv::Mat_<float> metres;
  test::raw_depth_image(1).convertTo(metres, CV_32F, 1e-3);
  write("/depth/image", 1, image_of(metres, "32FC1", 1, "depth"));
  EXPECT_THAT(error_of<std::runtime_error>([&] { (void)open(); }),
              HasSubstr("/depth/image: image 1 is in metres and others are not"));
}

TEST_F(RosBag, ImagesOfAClockThatWasSetBackAreCounted) {
  write("/depth/camera_info", 0, camera(50.0, test::kWidth, test::kHeight));
  for (int frame = 0; frame < 4; ++frame) {
    Image image = image_of(test::raw_depth_image(frame), "16UC1", frame, "depth");
    if (frame == 3) image.header.stamp = time_of(1);
    write("/depth/image", frame, image);
  }
  const FileRecording recording = open();
  EXPECT_EQ(recording.num_depth_frames(), 3);
  EXPECT_THAT(recording.remark(), HasSubstr("1 of 4 images of /depth/image are left out"));
}

TEST(RosTopics, RegisteredRawDepthIsPreferred) {
  const std::vector<ros1::Topic> topics = {
      {"/cam/aligned_depth_to_color/camera_info", "sensor_msgs/CameraInfo"},
      {"/cam/aligned_depth_to_color/image_raw", "sensor_msgs/Image"},
      {"/cam/aligned_depth_to_color/image_raw/compressed", "sensor_msgs/CompressedImage"},
      {"/cam/aligned_depth_to_color/image_raw/compressedDepth", "sensor_msgs/CompressedImage"},
      {"/cam/color/camera_info", "sensor_msgs/CameraInfo"},
      {"/cam/color/image_raw/compressed", "sensor_msgs/CompressedImage"},
      {"/cam/depth/camera_info", "sensor_msgs/CameraInfo"},
      {"/cam/depth/image_rect_raw", "sensor_msgs/Image"},
      {"/cam/infra1/image_rect_raw", "sensor_msgs/Image"}};
  const ros1::CameraTopics chosen = ros1::choose_topics(topics, "", "");
  EXPECT_EQ(chosen.depth, "/cam/aligned_depth_to_color/image_raw");
  EXPECT_EQ(chosen.depth_camera, "/cam/aligned_depth_to_color/camera_info");
  EXPECT_EQ(chosen.color, "/cam/color/image_raw/compressed");
  EXPECT_EQ(chosen.color_camera, "/cam/color/camera_info");
}

TEST(RosTopics, TheRealSenseSdkHasAnInfoBesideImage) {
  const std::vector<ros1::Topic> topics = {
      {"/device_0/sensor_0/Depth_0/image/data", "sensor_msgs/Image"},
      {"/device_0/sensor_0/Depth_0/info/camera_info", "sensor_msgs/CameraInfo"},
      {"/device_0/sensor_1/Color_0/image/data", "sensor_msgs/Image"},
      {"/device_0/sensor_1/Color_0/info/camera_info", "sensor_msgs/CameraInfo"}};
  const ros1::CameraTopics chosen = ros1::choose_topics(topics, "", "");
  EXPECT_EQ(chosen.depth_camera, "/device_0/sensor_0/Depth_0/info/camera_info");
  EXPECT_EQ(chosen.color_camera, "/device_0/sensor_1/Color_0/info/camera_info");
}

}  // namespace
}  // namespace kintsugi::mapper
