// Folders of images that have numbers: 7-Scenes, ScanNet's export, Redwood, Open3D.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/mapper/openni2_driver/formats/written_recordings.hpp"

namespace kintsugi::mapper {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using test::open_recording_at;
using test::same;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr const char* kCamera = "50 51 31.5 23.5 64 48 1000\n";

void write_depth(const fs::path& file, int frame) {
  fs::create_directories(file.parent_path());
  cv::imwrite(file.string(), test::raw_depth_image(frame));
}

void write_color(const fs::path& file, int frame) {
  fs::create_directories(file.parent_path());
  test::write_color(file, test::color_image(frame));
}

std::string pose_text(double z) {
  return "1 0 0 0\n0 1 0 0\n0 0 1 " + std::to_string(z) + "\n0 0 0 1\n";
}

TEST(SevenScenesFolder, IsReadWithItsPoses) {
  const kintsugi::testing::TemporaryFolder folder;
  for (const int frame : {0, 1, 2}) {
    const std::string name = "frame-00000" + std::to_string(frame);
    write_depth(folder / (name + ".depth.png"), frame);
    write_color(folder / (name + ".color.png"), frame);
    test::write_text(folder / (name + ".pose.txt"), pose_text(frame));
  }
  test::write_text(folder / "camera.txt", kCamera);
  FileRecording recording = open_recording_at(folder.path());
  ASSERT_EQ(recording.num_depth_frames(), 3);
  ASSERT_EQ(recording.num_color_frames(), 3);
  EXPECT_EQ(recording.frame_rate_hz(), 30);
  EXPECT_TRUE(same(recording.depth(1, DepthUnit::k1mm), test::raw_depth_image(1)));
  EXPECT_TRUE(same(recording.color(2), test::color_image(2)));
  EXPECT_EQ(recording.depth_X_WC(2).value().translation().z(), 2.0);
}

TEST(SevenScenesFolder, HasTheKinectOfItsAuthorsWithoutACameraFile) {
  const kintsugi::testing::TemporaryFolder folder;
  write_depth(folder / "frame-000000.depth.png", 0);
  const FileRecording recording = open_recording_at(folder.path());
  EXPECT_EQ(recording.intrinsics().fx, 585.0);
  EXPECT_THAT(recording.remark(), HasSubstr("7-Scenes"));
}

class ScanNetFolder : public ::testing::Test {
 protected:
  ScanNetFolder() {
    for (const int frame : {0, 2, 10}) {
      const std::string name = std::to_string(frame);
      write_depth(folder_ / ("depth/" + name + ".png"), frame % 3);
      fs::create_directories(folder_ / "color");
      cv::Mat_<cv::Vec3b> twice;
      cv::resize(test::color_image(frame % 3), twice, {}, 2.0, 2.0, cv::INTER_NEAREST);
      test::write_color(folder_ / ("color/" + name + ".png"), twice);
      fs::create_directories(folder_ / "pose");
      test::write_text(folder_ / ("pose/" + name + ".txt"),
                       frame == 2 ? "-inf -inf -inf -inf\n" : pose_text(frame));
    }
    fs::create_directories(folder_ / "intrinsic");
    test::write_text(folder_ / "intrinsic/intrinsic_depth.txt",
                     "50 0 31.5 0\n0 50 23.5 0\n0 0 1 0\n0 0 0 1\n");
    test::write_text(folder_ / "intrinsic/intrinsic_color.txt",
                     "100 0 63.5 0\n0 100 47.5 0\n0 0 1 0\n0 0 0 1\n");
  }

  kintsugi::testing::TemporaryFolder folder_;
};

TEST_F(ScanNetFolder, IsReadInTheOrderOfItsNumbers) {
  FileRecording recording = open_recording_at(folder_.path());
  ASSERT_EQ(recording.num_depth_frames(), 3);
  EXPECT_EQ(recording.depth_utime(2), 333'333) << "frame 10, after 2";
  EXPECT_TRUE(same(recording.depth(1, DepthUnit::k1mm), test::raw_depth_image(2)));
  EXPECT_EQ(recording.depth_X_WC(2).value().translation().z(), 10.0);
  EXPECT_FALSE(recording.depth_X_WC(1)) << "-inf where ScanNet lost the camera";
}

TEST_F(ScanNetFolder, ColourOfAnotherSizeGetsThePixelsOfDepth) {
  FileRecording recording = open_recording_at(folder_.path());
  // Twice the focal length and each pixel doubled: halved, it is the image before.
  EXPECT_LE(cv::norm(recording.color(0)(cv::Rect(1, 1, test::kWidth - 2, test::kHeight - 2)),
                     test::color_image(0)(cv::Rect(1, 1, test::kWidth - 2, test::kHeight - 2)),
                     cv::NORM_INF),
            4.0);
}

TEST_F(ScanNetFolder, NamesTheLineOfACameraThatIsNone) {
  test::write_text(folder_ / "intrinsic/intrinsic_depth.txt", "50 0 31.5 0\n0 x 23.5 0\n0 0 1 0\n");
  EXPECT_THAT(error_of<std::runtime_error>([&] { (void)open_recording_at(folder_.path()); }),
              AllOf(HasSubstr("intrinsic_depth.txt:2: "), HasSubstr("'x'")));
}

TEST(NumberedFolder, RedwoodsNamesHaveTheTimes) {
  const kintsugi::testing::TemporaryFolder folder;
  write_depth(folder / "depth/0000001-000000000000.png", 0);
  write_depth(folder / "depth/0000002-000000033369.png", 1);
  write_color(folder / "image/0000001-000000000020.png", 0);
  const FileRecording recording = open_recording_at(folder.path());
  EXPECT_EQ(recording.depth_utime(1), 33'369);
  EXPECT_EQ(recording.color_utime(0), 20);
  EXPECT_EQ(recording.intrinsics().fx, 525.0);
  EXPECT_THAT(recording.remark(), HasSubstr("PrimeSense"));
}

TEST(NumberedFolder, Open3DsCameraIsReadByColumns) {
  const kintsugi::testing::TemporaryFolder folder;
  write_depth(folder / "depth/000000.png", 0);
  write_color(folder / "color/000000.png", 0);
  test::write_text(folder / "camera_intrinsic.json",
                   R"({"width": 64, "height": 48,
                       "intrinsic_matrix": [50, 0, 0, 0, 51, 0, 31.5, 23.5, 1]})");
  FileRecording recording = open_recording_at(folder.path());
  EXPECT_EQ(recording.intrinsics().fy, 51.0);
  EXPECT_EQ(recording.intrinsics().cx, 31.5);
  EXPECT_EQ(recording.intrinsics().cy, 23.5);
  EXPECT_TRUE(same(recording.color(0), test::color_image(0)));
}

TEST(NumberedFolder, WithoutACameraItSaysWhatToWrite) {
  const kintsugi::testing::TemporaryFolder folder;
  write_depth(folder / "depth/0.png", 0);
  EXPECT_THAT(error_of<std::runtime_error>([&] { (void)open_recording_at(folder.path()); }),
              AllOf(HasSubstr("camera.txt"), HasSubstr("fx fy cx cy")));
}

TEST(NumberedFolder, TwoImagesOfOneNumberAreNamed) {
  const kintsugi::testing::TemporaryFolder folder;
  write_depth(folder / "depth/1.png", 0);
  write_depth(folder / "depth/01.png", 0);
  EXPECT_THAT(error_of<std::runtime_error>([&] { (void)open_recording_at(folder.path()); }),
              AllOf(HasSubstr("/1.png"), HasSubstr("/01.png"), HasSubstr("same number")));
}

}  // namespace
}  // namespace kintsugi::mapper
