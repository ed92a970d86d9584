// Recordings that are written come back through the readers, and from a log through the bus's
// codec.

#include <filesystem>
#include <iterator>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/channels.hpp"
#include "lcmtypes/codec/codec.hpp"
#include "lcmtypes/log/log_reader.hpp"
#include "lcmtypes/stream/message_assembler.hpp"
#include "mapper/conversion/recording_writer.hpp"
#include "mapper/openni2_driver/formats/read_recording.hpp"
#include "mapper/openni2_driver/recording/file_recording.hpp"
#include "mapper/source/open_source.hpp"
#include "tests/mapper/openni2_driver/recording_folder.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::mapper {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using ::testing::HasSubstr;

constexpr WritingOptions kLossless = {.jpeg_quality = 0};

RgbdFrame frame_of(int number, bool with_color = true) {
  RgbdFrame frame;
  frame.utime = test::RecordingFolder::depth_utime(number);
  frame.frame_index = number;
  frame.intrinsics = {.fx = 50.25,
                      .fy = 51.5,
                      .cx = 31.5,
                      .cy = 23.5,
                      .width = test::kWidth,
                      .height = test::kHeight,
                      .distortion = {}};
  cv::Mat_<std::uint16_t> raw = test::raw_depth_image(number);
  raw.convertTo(frame.depth_m, CV_32F, 1e-3);
  frame.depth_m.setTo(std::numeric_limits<float>::quiet_NaN(), raw == 0);
  if (with_color) frame.color_rgb = test::color_image(number);
  return frame;
}

bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0.0;
}

class RecordingWriterTest : public ::testing::Test {
 protected:
  fs::path write(const char* name, const WritingOptions& options, const Trajectory& poses = {}) {
    const fs::path path = folder_ / name;
    const auto writer = open_recording_writer(path, options);
    for (const int number : {0, 1, 2}) {
      writer->add(frame_of(number, number != 1));
      EXPECT_FALSE(fs::exists(path)) << "before it is complete";
    }
    writer->finish(poses);
    return path;
  }

  [[nodiscard]] std::size_t num_entries() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()));
  }

  kintsugi::testing::TemporaryFolder folder_;
};

void expect_the_frames(const fs::path& path) {
  FileRecording recording(read_recording(path, {}));
  ASSERT_EQ(recording.num_depth_frames(), 3);
  ASSERT_EQ(recording.num_color_frames(), 2) << "the second frame has none";
  for (const int number : {0, 1, 2}) {
    EXPECT_EQ(recording.depth_utime(number), test::RecordingFolder::depth_utime(number));
    EXPECT_TRUE(same(recording.depth(number, DepthUnit::k1mm), test::raw_depth_image(number)));
  }
  EXPECT_TRUE(same(recording.color(1), test::color_image(2)));
}

TEST_F(RecordingWriterTest, ATumFolderComesBackToTheBit) {
  Trajectory poses = {{.utime = test::RecordingFolder::depth_utime(0)}};
  poses.front().X_WC.translation().x() = 0.25;
  const fs::path path = write("walk/", {}, poses);
  expect_the_frames(path);
  EXPECT_EQ(FileRecording(read_recording(path, {})).intrinsics().fx, 50.25);
  const Trajectory read_back = read_tum_file((path / "groundtruth.txt").string());
  ASSERT_EQ(read_back.size(), 1U);
  EXPECT_EQ(read_back.front().utime, poses.front().utime);
  EXPECT_EQ(read_back.front().X_WC.translation().x(), 0.25);
}

TEST_F(RecordingWriterTest, AKlgFileComesBackToTheBitWithItsCameraBeside) {
  const fs::path path = write("walk.klg", kLossless);
  expect_the_frames(path);
  const FileRecording recording(read_recording(path, {}));
  EXPECT_EQ(recording.intrinsics().fy, 51.5) << "of walk.klg.camera.txt, and not the default";
  EXPECT_EQ(recording.remark(), "");
}

/// That is for .oni files, which do not tell their camera.
TEST_F(RecordingWriterTest, AKlgFileBesideACameraTxtHasItsOwnCamera) {
  SourceConfig config;
  config.device = write("walk.klg", kLossless).string();
  test::write_text(folder_ / "camera.txt", "60 61 30 20 64 48 1000 0.1 0 0 0 0\n");
  const auto frame = open_frame_source(config)->next();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->intrinsics.fx, 50.25);
}

TEST_F(RecordingWriterTest, JpegIsSmallerAndLosesLittle) {
  const fs::path exact = write("exact.klg", kLossless);
  const fs::path small = write("small.klg", {.jpeg_quality = 95});
  EXPECT_LT(fs::file_size(small), fs::file_size(exact));
  FileRecording recording(read_recording(small, {}));
  EXPECT_LT(cv::norm(recording.color(0), test::color_image(0), cv::NORM_INF), 30.0);
}

TEST_F(RecordingWriterTest, ALogHasTheFramesAtTheirTimes) {
  LogReader log(write("walk.lcm", kLossless));
  MessageAssembler<RgbdFrameMessage> assembler;
  int number = 0;
  while (const auto event = log.next()) {
    if (event->channel != channels::kRgbdFrame) continue;
    EXPECT_EQ(event->utime, test::RecordingFolder::depth_utime(number));
    const auto chunks = assembler.add(decode_chunk<RgbdFrameMessage>(event->data));
    if (chunks.empty()) continue;
    const auto message = join<RgbdFrameMessage>(chunks);
    EXPECT_EQ(message.utime, test::RecordingFolder::depth_utime(number));
    EXPECT_EQ(message.intrinsics.fx, 50.25);
    ++number;
  }
  EXPECT_EQ(number, 3);
  EXPECT_FALSE(log.damage());
}

TEST_F(RecordingWriterTest, WhatExistsIsNotOverwritten) {
  test::write_text(folder_ / "walk.klg", "mine");
  EXPECT_THAT(
      error_of<std::runtime_error>([&] { (void)open_recording_writer(folder_ / "walk.klg", {}); }),
      HasSubstr("walk.klg: exists"));
}

TEST_F(RecordingWriterTest, WithoutFinishNothingStays) {
  for (const char* name : {"walk", "walk.klg", "walk.lcm"}) {
    const auto writer = open_recording_writer(folder_ / name, {});
    writer->add(frame_of(0));
  }
  EXPECT_EQ(num_entries(), 0U);
}

TEST_F(RecordingWriterTest, AFullDiskIsAnErrorAndLeavesNothing) {
  for (const char* name : {"walk", "walk.klg", "walk.lcm"}) {
    EXPECT_THAT(error_of<std::system_error>([&] {
                  const kintsugi::testing::FileSizeLimit limit(1000);
                  const auto writer = open_recording_writer(folder_ / name, kLossless);
                  for (int number = 0; number < 40; ++number) writer->add(frame_of(number));
                  writer->finish({});
                }),
                HasSubstr((folder_ / "walk").string()));
    EXPECT_EQ(num_entries(), 0U) << name;
  }
}

}  // namespace
}  // namespace kintsugi::mapper
