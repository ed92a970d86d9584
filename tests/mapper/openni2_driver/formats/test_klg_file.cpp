#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/mapper/openni2_driver/formats/written_recordings.hpp"

namespace kintsugi::mapper {
namespace {

using test::error_of;
using test::klg_bytes;
using test::KlgImages;
using test::open_recording_at;
using test::same;
using ::testing::AllOf;
using ::testing::HasSubstr;

class KlgFile : public ::testing::Test {
 protected:
  static KlgImages packed(int frame) {
    return {test::deflated(test::raw_depth_image(frame)),
            test::encoded(test::color_image(frame), ".jpg")};
  }
  static KlgImages raw(int frame) {
    return {test::raw_bytes(test::raw_depth_image(frame)),
            test::raw_bytes(test::color_image(frame))};
  }

  [[nodiscard]] FileRecording open(const std::string& bytes, bool swap_colors = false) const {
    test::write_text(file_, bytes);
    return open_recording_at(file_,
                             {.depth_topic = "", .color_topic = "", .swap_colors = swap_colors});
  }

  kintsugi::testing::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "walk.klg";
};

TEST_F(KlgFile, CompressedImagesComeBack) {
  FileRecording recording = open(klg_bytes({packed(0), packed(1)}, 2));
  EXPECT_EQ(recording.num_depth_frames(), 2);
  EXPECT_EQ(recording.num_color_frames(), 2);
  EXPECT_EQ(recording.depth_utime(1), test::RecordingFolder::depth_utime(1));
  EXPECT_TRUE(same(recording.depth(1, DepthUnit::k1mm), test::raw_depth_image(1)));
  // JPEG keeps a smooth image to a few grey levels.
  EXPECT_LT(cv::norm(recording.color(1), test::color_image(1), cv::NORM_INF), 30.0);
  EXPECT_LT(cv::norm(recording.color(1), test::color_image(1), cv::NORM_L1) /
                (3.0 * test::kWidth * test::kHeight),
            3.0);
}

TEST_F(KlgFile, RawImagesComeBackToTheBitInAnyOrder) {
  FileRecording recording = open(klg_bytes({raw(0), raw(1), raw(2)}, 3));
  for (const int frame : {2, 0, 1}) {
    EXPECT_TRUE(same(recording.depth(frame, DepthUnit::k1mm), test::raw_depth_image(frame)));
    EXPECT_TRUE(same(recording.color(frame), test::color_image(frame)));
  }
  EXPECT_EQ(recording.intrinsics().width, test::kWidth);
  EXPECT_EQ(recording.intrinsics().height, test::kHeight);
}

TEST_F(KlgFile, SaysThatItsCameraIsADefault) {
  const FileRecording recording = open(klg_bytes({raw(0)}, 1));
  EXPECT_DOUBLE_EQ(recording.intrinsics().fx, 528.0 * test::kWidth / 640.0);
  EXPECT_THAT(recording.remark(), AllOf(HasSubstr("528"), HasSubstr("--calibration")));
}

TEST_F(KlgFile, SwapsRedAndBlueOnRequest) {
  FileRecording recording = open(klg_bytes({raw(1)}, 1), true);
  const cv::Vec3b stored = test::color_image(1)(3, 5);
  EXPECT_EQ(recording.color(0)(3, 5), cv::Vec3b(stored[2], stored[1], stored[0]));
}

TEST_F(KlgFile, WithoutColourThereIsDepth) {
  KlgImages depth_only = packed(0);
  depth_only.color.clear();
  const FileRecording recording = open(klg_bytes({depth_only, packed(1)}, 2));
  EXPECT_EQ(recording.num_depth_frames(), 2);
  EXPECT_EQ(recording.num_color_frames(), 1);
  EXPECT_EQ(recording.color_utime(0), recording.depth_utime(1));
}

TEST_F(KlgFile, OfACutOffFileTheCompleteFramesAreRead) {
  const std::string whole = klg_bytes({raw(0), raw(1), raw(2)}, 3);
  FileRecording recording = open(whole.substr(0, whole.size() - 5));
  EXPECT_EQ(recording.num_depth_frames(), 2);
  EXPECT_THAT(recording.remark(), AllOf(HasSubstr("3 frames"), HasSubstr("2 are complete")));
  EXPECT_TRUE(same(recording.depth(1, DepthUnit::k1mm), test::raw_depth_image(1)));
}

TEST_F(KlgFile, HostileSizesAreRefusedBeforeMemoryIsTaken) {
  std::string bytes = klg_bytes({raw(0), raw(1)}, 2);
  const std::size_t second_frame = 4 + (bytes.size() - 4) / 2;
  const std::int32_t huge = -5;
  bytes.replace(second_frame + 8, 4, reinterpret_cast<const char*>(&huge), 4);
  EXPECT_THAT(error_of<std::runtime_error>([&] { (void)open(bytes); }),
              AllOf(HasSubstr("walk.klg"), HasSubstr("frame 1"), HasSubstr("-5 bytes of depth")));
}

TEST_F(KlgFile, AJpegOfNoSizeDoesNotTellTheSize) {
  KlgImages images = packed(0);
  // The frame header of a JPEG: ff c0, length, bits, height, width.
  const std::vector<std::uint8_t> start_of_frame = {0xff, 0xc0};
  const auto place = std::ranges::search(images.color, start_of_frame).begin();
  ASSERT_NE(place, images.color.end());
  std::fill(place + 5, place + 9, std::uint8_t{0});
  EXPECT_EQ(open(klg_bytes({images}, 1)).intrinsics().width, test::kWidth) << "that of the depth";
}

TEST_F(KlgFile, ADamagedImageIsNamedAndTheOthersAreRead) {
  KlgImages damaged = packed(1);
  damaged.depth[damaged.depth.size() / 2] ^= 0xff;
  FileRecording recording = open(klg_bytes({packed(0), damaged, packed(2)}, 3));
  EXPECT_THAT(error_of<std::runtime_error>([&] { (void)recording.depth(1, DepthUnit::k1mm); }),
              AllOf(HasSubstr("walk.klg"), HasSubstr(std::to_string(recording.depth_utime(1)))));
  EXPECT_TRUE(same(recording.depth(2, DepthUnit::k1mm), test::raw_depth_image(2)));
}

}  // namespace
}  // namespace kintsugi::mapper
