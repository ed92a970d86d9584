#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/mapper/openni2_driver/formats/written_recordings.hpp"

namespace kintsugi::mapper {
namespace {

using test::error_of;
using test::open_recording_at;
using test::same;
using ::testing::AllOf;
using ::testing::HasSubstr;

struct Stream {
  std::uint32_t version = 4;
  std::int32_t depth_compression = 1;
  double baseline_m = 0.0;
  std::uint64_t announced = 3;
  int width = test::kWidth;  ///< that the header says
  std::vector<std::uint64_t> stamps = {1'000'000, 1'033'333, 1'066'666};
};

void put_matrix(test::Bytes& bytes, const Eigen::Matrix4f& matrix) {
  for (int i = 0; i < 16; ++i) bytes.put(matrix(i / 4, i % 4));
}

Eigen::Matrix4f camera_matrix(float f, float cx, float cy) {
  Eigen::Matrix4f K = Eigen::Matrix4f::Identity();
  K(0, 0) = f;
  K(1, 1) = f;
  K(0, 2) = cx;
  K(1, 2) = cy;
  return K;
}

std::string bytes_of(const Stream& stream) {
  test::Bytes bytes;
  const std::string name = "StructureSensor";
  bytes.put(stream.version).put(static_cast<std::uint64_t>(name.size()));
  bytes.put(std::vector<std::uint8_t>(name.begin(), name.end()));
  Eigen::Matrix4f color_pose = Eigen::Matrix4f::Identity();
  color_pose(0, 3) = static_cast<float>(stream.baseline_m);
  put_matrix(bytes, camera_matrix(50.0F, 31.5F, 23.5F));
  put_matrix(bytes, color_pose);
  put_matrix(bytes, camera_matrix(50.0F, 31.5F, 23.5F));
  put_matrix(bytes, Eigen::Matrix4f::Identity());
  bytes.put(std::int32_t{2}).put(stream.depth_compression);
  for (int camera = 0; camera < 2; ++camera) {
    bytes.put(static_cast<std::uint32_t>(stream.width));
    bytes.put(static_cast<std::uint32_t>(test::kHeight));
  }
  bytes.put(1000.0F).put(stream.announced);
  for (std::size_t i = 0; i < stream.stamps.size(); ++i) {
    const int frame = static_cast<int>(i);
    Eigen::Matrix4f X_WC = Eigen::Matrix4f::Identity();
    X_WC(2, 3) = static_cast<float>(frame);
    if (frame == 1) X_WC(0, 0) = -std::numeric_limits<float>::infinity();  // lost
    put_matrix(bytes, X_WC);
    const auto color = test::encoded(test::color_image(frame), ".png");
    const auto depth = test::deflated(test::raw_depth_image(frame));
    bytes.put(stream.stamps[i]).put(stream.stamps[i]);
    bytes.put(static_cast<std::uint64_t>(color.size()));
    bytes.put(static_cast<std::uint64_t>(depth.size()));
    bytes.put(color).put(depth);
  }
  bytes.put(std::uint64_t{0});  // motion sensor
  return bytes.text();
}

class SensFile : public ::testing::Test {
 protected:
  [[nodiscard]] FileRecording open(const std::string& bytes) const {
    test::write_text(file_, bytes);
    return open_recording_at(file_);
  }

  kintsugi::testing::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "scene.sens";
};

TEST_F(SensFile, ImagesTimesAndPosesComeBack) {
  FileRecording recording = open(bytes_of({}));
  ASSERT_EQ(recording.num_depth_frames(), 3);
  ASSERT_EQ(recording.num_color_frames(), 3);
  EXPECT_EQ(recording.name(), "StructureSensor");
  EXPECT_EQ(recording.depth_utime(2) - recording.depth_utime(1), 33'333);
  for (const int frame : {1, 0, 2}) {
    EXPECT_TRUE(same(recording.depth(frame, DepthUnit::k1mm), test::raw_depth_image(frame)));
    EXPECT_TRUE(same(recording.color(frame), test::color_image(frame)));
  }
  ASSERT_TRUE(recording.depth_X_WC(2));
  EXPECT_EQ(recording.depth_X_WC(2)->translation().z(), 2.0);
  EXPECT_FALSE(recording.depth_X_WC(1)) << "the camera was lost there";
}

TEST_F(SensFile, TimesInMillisecondsAreMilliseconds) {
  Stream stream;
  stream.stamps = {10, 43, 77};
  EXPECT_EQ(open(bytes_of(stream)).depth_utime(2), 67'000) << "from the first frame on";
}

TEST_F(SensFile, TimesThatDoNotAscendAreReplacedAndItSaysSo) {
  Stream stream;
  stream.stamps = {0, 0, 0};
  const FileRecording recording = open(bytes_of(stream));
  EXPECT_EQ(recording.depth_utime(2), 66'667);
  EXPECT_THAT(recording.remark(), HasSubstr("30 frames a second"));
}

TEST_F(SensFile, ColourOfACameraBesideIsShiftedByTheDepth) {
  Stream stream;
  stream.baseline_m = 0.05;  // the colour camera is to the right of the depth camera
  FileRecording recording = open(bytes_of(stream));
  // A point z m away in front of the depth camera is f * 0.05 / z pixels farther left in colour.
  const cv::Mat_<std::uint16_t> depth = test::raw_depth_image(0);
  const cv::Mat_<cv::Vec3b> registered = recording.color(0);
  int compared = 0;
  for (int x = 20; x < test::kWidth; ++x) {
    const int y = 20;
    if (depth(y, x) == 0) continue;
    const double shift_px = 50.0 * 0.05 / (1e-3 * depth(y, x));
    // The red of the test image is 4 times the column.
    EXPECT_NEAR(registered(y, x)[0], 4.0 * (x - shift_px), 1.5) << "column " << x;
    ++compared;
  }
  EXPECT_GT(compared, 20);
}

TEST_F(SensFile, OfACutOffFileTheCompleteFramesAreRead) {
  const std::string whole = bytes_of({});
  const FileRecording recording = open(whole.substr(0, whole.size() - 100));
  EXPECT_EQ(recording.num_depth_frames(), 2);
  EXPECT_THAT(recording.remark(), AllOf(HasSubstr("3 frames"), HasSubstr("2 are complete")));
}

TEST_F(SensFile, SizesThatNoImageHasAreRefusedBeforeMemoryIsTaken) {
  for (const int width : {4096, 5000}) {
    Stream stream;
    stream.width = width;
    stream.baseline_m = 0.05;  // colour needs memory by the size of depth
    test::write_text(folder_ / "scene.sens", bytes_of(stream));
    EXPECT_TRUE(error_of<std::runtime_error>([&] {
                  (void)open_recording_at(file_);
                }).find("scene.sens") != std::string::npos);
  }
}

TEST_F(SensFile, AnUnknownCompressionIsRefused) {
  Stream stream;
  stream.depth_compression = 2;
  test::write_text(file_, bytes_of(stream));
  EXPECT_THAT(error_of<std::runtime_error>([&] { (void)open_recording_at(file_); }),
              HasSubstr("scene.sens"));
}

}  // namespace
}  // namespace kintsugi::mapper
