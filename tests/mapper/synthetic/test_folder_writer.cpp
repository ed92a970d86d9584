#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <unistd.h>

#include "mapper/openni2_driver/formats/read_recording.hpp"
#include "mapper/openni2_driver/recording/file_recording.hpp"
#include "mapper/synthetic/render/folder_writer.hpp"

namespace kintsugi::synthetic {
namespace {

TEST(FrameRange, IsReadAndChecked) {
  const auto is = [](const char* text, int first, int end, int step) {
    const FrameRange range = FrameRange::parse(text, 100);
    return range.first == first && range.end == end && range.step == step;
  };
  EXPECT_TRUE(is("", 0, 100, 1));
  EXPECT_TRUE(is("5:9", 5, 9, 1));
  EXPECT_TRUE(is("5:90:10", 5, 90, 10));
  EXPECT_TRUE(is("::7", 0, 100, 7));
  EXPECT_TRUE(is("98:", 98, 100, 1));
  for (const char* bad : {"a", "5:5", "0:101", "-1:5", "0:5:0", "0:5:1:1", "1;5"}) {
    EXPECT_THROW(FrameRange::parse(bad, 100), std::invalid_argument) << bad;
  }
}

TEST(FolderWriter, FolderPlaysBackWhatWasRendered) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("kintsugi_folder_" + std::to_string(getpid()));
  Sequence sequence(Sequence::Config::parse("box-room", {{"frames", "20"}}));
  FolderWriter writer(sequence, folder);
  for (int frame : {0, 10}) writer.write_frame(frame);
  writer.finish();

  mapper::FileRecording recording(mapper::read_recording(folder, {}));
  ASSERT_EQ(recording.num_depth_frames(), 2);
  ASSERT_EQ(recording.num_color_frames(), 2);
  EXPECT_EQ(recording.depth_utime(1), sequence.utime(10));
  EXPECT_EQ(recording.intrinsics(), sequence.intrinsics());
  const cv::Mat_<std::uint16_t> depth = recording.depth(1, mapper::DepthUnit::k1mm);
  const cv::Mat_<std::uint16_t> expected = sequence.depth_mm(10);
  EXPECT_TRUE(std::equal(depth.begin(), depth.end(), expected.begin(), expected.end()));
  const cv::Mat_<cv::Vec3b> color = recording.color(1);
  const cv::Mat_<cv::Vec3b>& rendered = sequence.truth(10).color_rgb;
  EXPECT_TRUE(std::equal(color.begin(), color.end(), rendered.begin(), rendered.end()));
  const cv::Mat_<std::uint16_t> instances =
      cv::imread((folder / "instances" / "0.333333.png").string(), cv::IMREAD_UNCHANGED);
  const cv::Mat_<std::uint16_t>& truth = sequence.truth(10).instances;
  EXPECT_TRUE(std::equal(instances.begin(), instances.end(), truth.begin(), truth.end()));
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace kintsugi::synthetic
