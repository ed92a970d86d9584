#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/openni2_driver/formats/read_recording.hpp"
#include "mapper/openni2_driver/recording/file_recording.hpp"
#include "mapper/openni2_driver/recording/recording_uri.hpp"
#include "tests/mapper/openni2_driver/recording_folder.hpp"

namespace kintsugi::mapper {
namespace {

using test::error_of;
using test::RecordingFolder;
using testing::AllOf;
using testing::HasSubstr;

bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0.0;
}

FileRecording open(const std::filesystem::path& path) {
  return FileRecording(read_recording(path, {}));
}

std::string open_error(const RecordingFolder& folder) {
  return error_of<std::runtime_error>([&] { (void)open(folder.path()); });
}

void cut_in_half(const std::filesystem::path& file) {
  std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
}

TEST(TumFolder, KeepsTimesAndPixels) {
  const RecordingFolder folder;
  FileRecording recording = open(folder.path());
  ASSERT_EQ(recording.num_depth_frames(), test::kNumFrames);
  ASSERT_EQ(recording.num_color_frames(), test::kNumFrames);
  EXPECT_EQ(recording.frame_rate_hz(), 30);
  EXPECT_EQ(recording.finest_depth_unit(), DepthUnit::k1mm);
  EXPECT_EQ(recording.intrinsics().fy, 51.0);
  for (int i = 0; i < test::kNumFrames; ++i) {
    EXPECT_EQ(recording.depth_utime(i), RecordingFolder::depth_utime(i));
    EXPECT_EQ(recording.color_utime(i), RecordingFolder::color_utime(i));
    EXPECT_TRUE(same(recording.depth(i, DepthUnit::k1mm), test::raw_depth_image(i)));
    EXPECT_TRUE(same(recording.color(i), test::color_image(i)));
  }
}

TEST(TumFolder, ConvertsFinerDepthToBothUnits) {
  const RecordingFolder folder("50 51 31.5 23.5 64 48 5000\n");
  cv::Mat_<std::uint16_t> raw = test::raw_depth_image(0);
  raw(0, 0) = 65535;  // invalid
  raw(0, 1) = 65534;  // 13.107 m: beyond 100 um units
  raw(0, 2) = 0;
  raw(0, 3) = 5002;  // 1.0004 m
  raw(0, 4) = 5003;  // 1.0006 m
  cv::imwrite((folder.path() / "depth/0.png").string(), raw);

  FileRecording recording = open(folder.path());
  EXPECT_EQ(recording.finest_depth_unit(), DepthUnit::k100um);
  const auto fine = recording.depth(0, DepthUnit::k100um);
  const auto coarse = recording.depth(0, DepthUnit::k1mm);
  const std::vector<std::uint16_t> fine_row(fine[0], fine[0] + 5);
  const std::vector<std::uint16_t> coarse_row(coarse[0], coarse[0] + 5);
  EXPECT_THAT(fine_row, testing::ElementsAre(0, 0, 0, 10004, 10006));
  EXPECT_THAT(coarse_row, testing::ElementsAre(0, 13107, 0, 1000, 1001));
}

TEST(TumFolder, ReadsAssociationsInEitherOrderAndDropsRepeats) {
  const RecordingFolder folder;
  std::filesystem::remove(folder.path() / "depth.txt");
  std::filesystem::remove(folder.path() / "rgb.txt");
  test::write_text(folder.path() / "associations.txt",
                   "0.1 rgb/0.png 0.10 depth/0.png\n"
                   "0.1 rgb/0.png 0.13 depth/1.png\n"
                   "0.2 rgb/2.png 0.20 depth/2.png\n");
  const FileRecording recording = open(folder.path());
  EXPECT_EQ(recording.num_depth_frames(), 3);
  ASSERT_EQ(recording.num_color_frames(), 2);
  EXPECT_EQ(recording.color_utime(1), 200'000);
}

TEST(TumFolder, ToleratesMissingPartners) {
  const RecordingFolder folder;
  test::write_text(folder.path() / "rgb.txt", "5.0 rgb/1.png\n");
  EXPECT_EQ(open(folder.path()).num_color_frames(), 1);
  std::filesystem::remove(folder.path() / "rgb.txt");
  EXPECT_EQ(open(folder.path()).num_color_frames(), 0);
}

TEST(TumFolder, SaysWhatIsMissing) {
  EXPECT_THAT(error_of<std::runtime_error>([] { (void)open("/no/such/folder"); }),
              HasSubstr("/no/such/folder: no such file or folder"));
  {
    const RecordingFolder folder;
    std::filesystem::remove(folder.path() / "depth.txt");
    std::filesystem::remove_all(folder.path() / "depth");
    EXPECT_THAT(open_error(folder), AllOf(HasSubstr("depth.txt"), HasSubstr("associations.txt")));
  }
  {
    const RecordingFolder folder;
    std::filesystem::remove(folder.path() / "camera.txt");
    EXPECT_THAT(open_error(folder),
                AllOf(HasSubstr("has no camera.txt"), HasSubstr("fx fy cx cy")));
  }
  {
    const RecordingFolder folder;
    test::write_text(folder.path() / "depth.txt", "# nothing\n");
    EXPECT_THAT(open_error(folder), HasSubstr("depth.txt: lists no image"));
  }
}

TEST(TumFolder, FindsAMissingImageWhenItIsRead) {
  const RecordingFolder folder;
  std::filesystem::remove(folder.path() / "depth/2.png");
  FileRecording recording = open(folder.path());
  EXPECT_THAT(error_of<std::runtime_error>([&] { (void)recording.depth(2, DepthUnit::k1mm); }),
              HasSubstr("depth/2.png: cannot be read"));
  EXPECT_TRUE(same(recording.depth(3, DepthUnit::k1mm), test::raw_depth_image(3)));
}

TEST(TumFolder, TakesFrameNumbersAt30Hz) {
  const RecordingFolder folder;
  std::filesystem::remove(folder.path() / "depth.txt");
  test::write_text(folder.path() / "associations.txt",
                   "1 depth/0.png 1 rgb/0.png\n2 depth/1.png 2 rgb/1.png\n"
                   "4 depth/3.png 4 rgb/3.png\n");
  const FileRecording recording = open(folder.path());
  EXPECT_EQ(recording.depth_utime(0), 33'333);
  EXPECT_EQ(recording.depth_utime(1), 66'667);
  EXPECT_EQ(recording.depth_utime(2), 133'333);
  EXPECT_EQ(recording.color_utime(2), 133'333);
  EXPECT_EQ(recording.frame_rate_hz(), 15) << "the upper median of 1 and 2 frames";
  EXPECT_THAT(recording.remark(), AllOf(HasSubstr("frame numbers"), HasSubstr("30 frames")));
}

TEST(TumFolder, HasNoRemarkAboutSeconds) {
  const RecordingFolder folder;
  EXPECT_EQ(open(folder.path()).remark(), "");
}

TEST(TumFolder, RefusesLinesThatDoNotParse) {
  const RecordingFolder folder;
  const auto error = [&](const std::string& list) {
    test::write_text(folder.path() / "depth.txt", list);
    return open_error(folder);
  };
  EXPECT_THAT(error("0.1 depth/0.png\n0.2\n"), AllOf(HasSubstr(":2: "), HasSubstr("seconds file")));
  EXPECT_THAT(error("x depth/0.png\n"), AllOf(HasSubstr(":1: "), HasSubstr("'x'")));
  EXPECT_THAT(error("0.2 depth/0.png\n0.2 depth/1.png\n"), HasSubstr("must ascend"));
  EXPECT_THAT(error("0.2 depth/0.png\n0.1 depth/1.png\n"), HasSubstr("must ascend"));
}

TEST(TumFolder, RefusesImagesOfAnotherSizeOrType) {
  const RecordingFolder folder;
  const cv::Mat_<std::uint16_t> small(10, 20, std::uint16_t{1});
  cv::imwrite((folder.path() / "depth/0.png").string(), small);
  cv::imwrite((folder.path() / "depth/1.png").string(), test::color_image(0));
  test::write_color(folder.path() / "rgb/0.png", cv::Mat_<cv::Vec3b>(10, 20));
  cv::imwrite((folder.path() / "rgb/1.png").string(), test::raw_depth_image(0));
  FileRecording recording = open(folder.path());
  const auto depth_error = [&](int i) {
    return error_of<std::runtime_error>([&] { (void)recording.depth(i, DepthUnit::k1mm); });
  };
  const auto color_error = [&](int i) {
    return error_of<std::runtime_error>([&] { (void)recording.color(i); });
  };
  EXPECT_THAT(depth_error(0),
              AllOf(HasSubstr("depth/0.png"), HasSubstr("20x10"), HasSubstr("64x48")));
  EXPECT_THAT(depth_error(1), AllOf(HasSubstr("8 bit, 3 channels"), HasSubstr("16 bit")));
  EXPECT_THAT(color_error(0), AllOf(HasSubstr("rgb/0.png"), HasSubstr("20x10")));
  EXPECT_THAT(color_error(1), HasSubstr("16 bit, 1 channel"));
  EXPECT_TRUE(same(recording.color(2), test::color_image(2))) << "an error must not spoil the rest";
}

TEST(TumFolder, RefusesTruncatedImages) {
  const RecordingFolder folder;
  cut_in_half(folder.path() / "depth/0.png");
  test::write_text(folder.path() / "depth/1.png", "");
  test::write_text(folder.path() / "depth/2.png", "not an image at all");
  test::write_color(folder.path() / "rgb/0.jpg", test::color_image(0));
  cut_in_half(folder.path() / "rgb/0.jpg");
  test::write_text(folder.path() / "rgb.txt", "0.1 rgb/0.jpg\n");
  FileRecording recording = open(folder.path());
  const auto depth_error = [&](int i) {
    return error_of<std::runtime_error>([&] { (void)recording.depth(i, DepthUnit::k1mm); });
  };
  EXPECT_THAT(depth_error(0), AllOf(HasSubstr("depth/0.png"), HasSubstr("cut off")));
  EXPECT_THAT(depth_error(1), HasSubstr("is empty"));
  EXPECT_THAT(depth_error(2), HasSubstr("cannot be decoded"));
  EXPECT_THAT(error_of<std::runtime_error>([&] { (void)recording.color(0); }),
              AllOf(HasSubstr("rgb/0.jpg"), HasSubstr("cut off")));
}

TEST(RecordingUri, ParsesBothSchemes) {
  EXPECT_FALSE(parse_recording_uri("/dev/video0"));
  const auto folder = parse_recording_uri("folder:///data/a?camera=on");
  EXPECT_EQ(folder->path, "/data/a");
  EXPECT_TRUE(folder->imitation.camera);
  const auto uri = parse_recording_uri("synthetic://office?noise=0&seed=7");
  ASSERT_TRUE(uri);
  EXPECT_EQ(uri->scheme, RecordingUri::Scheme::kSynthetic);
  EXPECT_EQ(uri->path, "office");
  EXPECT_THAT(uri->options,
              testing::ElementsAre(testing::Pair("noise", "0"), testing::Pair("seed", "7")));
}

TEST(RecordingUri, RefusesMalformedOptions) {
  const auto error = [](const char* uri) {
    return error_of<std::invalid_argument>([&] { parse_recording_uri(uri); });
  };
  EXPECT_THAT(error("synthetic://office?noise"), HasSubstr("key=value"));
  EXPECT_THAT(error("synthetic://office?=1"), HasSubstr("key=value"));
  EXPECT_THAT(error("synthetic://office?a=1&a=2"), HasSubstr("twice"));
  EXPECT_THAT(error("folder://"), HasSubstr("nothing after the scheme"));
  EXPECT_THAT(error("synthetic://?a=1"), HasSubstr("nothing after the scheme"));
}

}  // namespace
}  // namespace kintsugi::mapper
