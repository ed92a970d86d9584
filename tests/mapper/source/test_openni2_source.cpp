#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/source/open_source.hpp"
#include "tests/mapper/openni2_driver/recording_folder.hpp"

namespace kintsugi::mapper {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using test::kNumFrames;
using test::RecordingFolder;
using testing::AllOf;
using testing::HasSubstr;

SourceConfig config_of(const std::string& device) {
  SourceConfig config;
  config.device = device;
  return config;
}

std::vector<RgbdFrame> read_all(FrameSource& source) {
  std::vector<RgbdFrame> frames;
  while (auto frame = source.next()) frames.push_back(std::move(*frame));
  return frames;
}

TEST(OpenNi2Source, ReadsEveryFrameOfAFolder) {
  const RecordingFolder folder;
  const auto source = open_frame_source(config_of(folder.uri()));
  EXPECT_EQ(source->status().frames_total, kNumFrames);
  const auto frames = read_all(*source);
  ASSERT_EQ(frames.size(), kNumFrames);
  for (int i = 0; i < kNumFrames; ++i) {
    const RgbdFrame& frame = frames[static_cast<std::size_t>(i)];
    EXPECT_EQ(frame.utime, RecordingFolder::depth_utime(i));
    EXPECT_EQ(frame.frame_index, i + 1);
    EXPECT_EQ(frame.intrinsics.cx, 31.5);
    EXPECT_EQ(cv::norm(frame.color_rgb, test::color_image(i), cv::NORM_INF), 0.0);
    EXPECT_TRUE(std::isnan(frame.depth_m(0, (11 - i) % 11)));
    EXPECT_EQ(frame.depth_m(5, 9), static_cast<float>(test::raw_depth(i, 9, 5) * 0.001));
  }
  EXPECT_TRUE(source->status().ended_well);
  EXPECT_EQ(source->status().counts.frames_delivered, kNumFrames);
  EXPECT_EQ(source->status().counts.frames_dropped, 0);
  EXPECT_FALSE(source->next()) << "and stays at its end";
}

TEST(OpenNi2Source, KeepsFinerDepthWithinItsReach) {
  const RecordingFolder folder("50 51 31.5 23.5 64 48 5000\n");
  SourceConfig config = config_of(folder.uri());
  config.max_range_m = 6.5;
  const auto fine = open_frame_source(config)->next();
  EXPECT_EQ(fine->depth_m(5, 9), static_cast<float>(test::raw_depth(0, 9, 5) * 2 * 0.0001));
  config.max_range_m = 10.0;
  const auto coarse = open_frame_source(config)->next();
  EXPECT_NEAR(coarse->depth_m(5, 9), fine->depth_m(5, 9), 0.0005F) << "to a millimetre";
}

TEST(OpenNi2Source, CountsTheFramesOfACameraThatALateReaderMissed) {
  const RecordingFolder folder;
  const auto source = open_frame_source(config_of(folder.uri() + "?camera=on"));
  const auto first = source->next();
  ASSERT_TRUE(first);
  std::this_thread::sleep_for(std::chrono::milliseconds(400));
  const auto late = source->next();
  ASSERT_TRUE(late);
  const SourceCounts counts = source->status().counts;
  EXPECT_EQ(counts.frames_delivered + counts.frames_dropped,
            late->frame_index - first->frame_index + 1);
}

TEST(OpenNi2Source, DeliversDepthWithoutAPartner) {
  const RecordingFolder folder;
  test::write_text(folder.path() / "rgb.txt", RecordingFolder::color_time(2) + " rgb/2.png\n");
  const auto source = open_frame_source(config_of(folder.uri()));
  const auto frames = read_all(*source);
  ASSERT_EQ(frames.size(), kNumFrames);
  for (int i = 0; i < kNumFrames; ++i) {
    EXPECT_EQ(frames[static_cast<std::size_t>(i)].color_rgb.empty(), i != 2) << i;
  }
  EXPECT_EQ(source->status().counts.depth_unpaired, kNumFrames - 1);
}

TEST(OpenNi2Source, TakesTheCalibrationFileItIsGiven) {
  const RecordingFolder folder;
  const fs::path file = folder.path() / "other.txt";
  SourceConfig config = config_of(folder.uri());
  config.calibration_file = file.string();
  test::write_text(file, "60 61 30 20 64 48 1000 0.1 0 0 0 0\n");
  const auto frame = open_frame_source(config)->next();
  EXPECT_EQ(frame->intrinsics.fx, 60.0);
  EXPECT_EQ(frame->intrinsics.distortion, (std::array<double, 5>{}));
  test::write_text(file, "60 61 30 20 640 480 1000\n");
  EXPECT_THAT(error_of<std::runtime_error>([&] { open_frame_source(config); }),
              AllOf(HasSubstr("other.txt"), HasSubstr("640x480"), HasSubstr("64x48")));
}

/// A source, and what it says.
struct Heard {
  explicit Heard(SourceConfig config) {
    config.notify = [this](const SourceNotice& notice) { notices.push_back(notice); };
    source = open_frame_source(config);
    frames = read_all(*source);
  }

  std::vector<SourceNotice> notices;
  std::unique_ptr<FrameSource> source;
  std::vector<RgbdFrame> frames;
};

TEST(OpenNi2Source, PassesOverImagesThatCannotBeRead) {
  const RecordingFolder folder;
  fs::remove(folder.path() / "depth/1.png");
  fs::resize_file(folder.path() / "depth/2.png", 40);
  fs::resize_file(folder.path() / "rgb/3.png", 40);
  const Heard heard(config_of(folder.uri()));
  ASSERT_EQ(heard.frames.size(), 3U);
  EXPECT_EQ(heard.frames[1].frame_index, 4);
  EXPECT_TRUE(heard.frames[1].color_rgb.empty()) << "depth without its colour";
  EXPECT_EQ(heard.frames[2].utime, RecordingFolder::depth_utime(4));
  EXPECT_FALSE(heard.frames[2].color_rgb.empty());
  const SourceStatus status = heard.source->status();
  EXPECT_TRUE(status.ended_well);
  EXPECT_EQ(status.counts.frames_bad, 3);
  EXPECT_EQ(status.counts.frames_dropped, 0) << "none came too fast";
  ASSERT_EQ(heard.notices.size(), 2U) << "the first one, and the total";
  EXPECT_EQ(heard.notices[0].kind, SourceNotice::Kind::kWarning);
  EXPECT_THAT(heard.notices[0].text, AllOf(HasSubstr(".png: "), HasSubstr("passed over")));
  EXPECT_THAT(heard.notices[1].text, HasSubstr("3 images of the recording were passed over"));
}

TEST(OpenNi2Source, WarnsWhenNoImageHasDepthWithinRange) {
  const RecordingFolder folder("50 51 31.5 23.5 64 48 10\n");  // raw depth would be 100 m and more
  const Heard heard(config_of(folder.uri()));
  EXPECT_EQ(heard.frames.size(), kNumFrames);
  ASSERT_EQ(heard.notices.size(), 1U);
  EXPECT_EQ(heard.notices[0].kind, SourceNotice::Kind::kWarning);
  EXPECT_THAT(heard.notices[0].text, HasSubstr("the first " + std::to_string(kNumFrames) +
                                               " depth images have no depth within 0 to 6.5 m"));
}

TEST(OpenNi2Source, FailsWhenNoImageCanBeUsed) {
  const Heard heard(config_of("synthetic://office?frames=3&misfit_every=1"));
  EXPECT_TRUE(heard.frames.empty());
  EXPECT_FALSE(heard.source->status().ended_well);
  EXPECT_THAT(heard.source->status().end_reason, HasSubstr("no depth image can be used"));
}

TEST(OpenNi2Source, FailsWhenNoImageCanBeRead) {
  const RecordingFolder folder;
  fs::remove_all(folder.path() / "depth");
  const Heard heard(config_of(folder.uri()));
  EXPECT_EQ(heard.frames.size(), 0U);
  EXPECT_FALSE(heard.source->status().ended_well);
  EXPECT_THAT(heard.source->status().end_reason,
              AllOf(HasSubstr("no depth image"), HasSubstr("depth/0.png: cannot be read")));
}

TEST(OpenNi2Source, TakesFrameNumbersAt30HzAndSaysSoOnce) {
  const RecordingFolder folder;
  std::string depth_list;
  std::string color_list;
  for (int i = 0; i < kNumFrames; ++i) {
    depth_list += std::to_string(i + 1) + " depth/" + std::to_string(i) + ".png\n";
    color_list += std::to_string(i + 1) + " rgb/" + std::to_string(i) + ".png\n";
  }
  test::write_text(folder.path() / "depth.txt", depth_list);
  test::write_text(folder.path() / "rgb.txt", color_list);
  const Heard heard(config_of(folder.uri()));
  ASSERT_EQ(heard.frames.size(), kNumFrames);
  EXPECT_EQ(heard.frames[0].utime, 33'333);
  EXPECT_EQ(heard.frames[4].utime, 166'667);
  for (const RgbdFrame& frame : heard.frames) EXPECT_FALSE(frame.color_rgb.empty());
  ASSERT_EQ(heard.notices.size(), 1U);
  EXPECT_EQ(heard.notices[0].kind, SourceNotice::Kind::kInformation);
  EXPECT_THAT(heard.notices[0].text, HasSubstr("frame numbers, not seconds"));
}

/// Rows as they are in the files are those of a camera whose y axis points up.
void expect_reversed(const Heard& heard) {
  ASSERT_EQ(heard.frames.size(), kNumFrames);
  const RgbdFrame& frame = heard.frames[2];
  EXPECT_EQ(frame.intrinsics.fy, 51.0);
  EXPECT_EQ(frame.intrinsics.cy, 48 - 1 - 20.5);
  EXPECT_EQ(frame.depth_m(48 - 1 - 5, 9), static_cast<float>(test::raw_depth(2, 9, 5) * 0.001));
  EXPECT_EQ(frame.color_rgb(48 - 1 - 5, 9), test::color_rgb(2, 9, 5));
  ASSERT_EQ(heard.notices.size(), 1U);
  EXPECT_THAT(heard.notices[0].text, HasSubstr("fy < 0"));
}

TEST(OpenNi2Source, ReversesRowsOfACameraWhoseYPointsUp) {
  const RecordingFolder folder("50 -51 31.5 20.5 64 48 1000\n");
  expect_reversed(Heard(config_of(folder.uri())));
}

TEST(OpenNi2Source, ReversesRowsOnceForTheCalibrationFileItIsGiven) {
  for (const char* own : {"50 51 31.5 23.5 64 48 1000\n", "50 -51 31.5 20.5 64 48 1000\n"}) {
    const RecordingFolder folder(own);
    const fs::path file = folder.path() / "other.txt";
    test::write_text(file, "50 -51 31.5 20.5 64 48 1000\n");
    SourceConfig config = config_of(folder.uri());
    config.calibration_file = file.string();
    expect_reversed(Heard(config));
  }
}

TEST(OpenNi2Source, StopsOnRequest) {
  const RecordingFolder folder;
  bool stop = false;
  SourceConfig config = config_of(folder.uri());
  config.stop_requested = [&] { return stop; };
  const auto source = open_frame_source(config);
  ASSERT_TRUE(source->next());
  stop = true;
  EXPECT_LE(read_all(*source).size(), 1U) << "at most what had been read already";
  EXPECT_EQ(source->status().end_reason, "stopped on request");
}

TEST(OpenNi2Source, APathIsEnoughForARecording) {
  const RecordingFolder folder;
  const auto source = open_frame_source(config_of(folder.path().string()));
  EXPECT_EQ(source->status().frames_total, test::kNumFrames);
  EXPECT_EQ(read_all(*source).size(), static_cast<std::size_t>(test::kNumFrames));
}

TEST(OpenNi2Source, SaysWhyItCannotOpen) {
  const RecordingFolder folder;
  const auto error = [](const std::string& device) {
    return error_of<std::runtime_error>([&] { open_frame_source(config_of(device)); });
  };
  EXPECT_THAT(error("/no/such/file.oni"), HasSubstr("/no/such/file.oni: no such file"));
  EXPECT_EQ(
      error("folder:///no/such/folder"),
      "cannot open device 'folder:///no/such/folder': /no/such/folder: no such file or folder");
  EXPECT_THAT(error("nowhere.klg"), HasSubstr("nowhere.klg: no such file or folder"));
  EXPECT_THAT(error("synthetic://no-such-room"), HasSubstr("no-such-room"));
  EXPECT_THAT(error("1d27/0601@9/99"), HasSubstr("cannot open device '1d27/0601@9/99'"));
  EXPECT_THAT(error("folder://" + std::string(300, 'x')), HasSubstr("255"));
  SourceConfig config = config_of(folder.uri());
  config.max_range_m = -1.0;
  EXPECT_THROW(open_frame_source(config), std::invalid_argument);
}

// Two files that other people recorded, with other versions of OpenNI. They are not part of the
// project: KINTSUGI_DATA names the folder that holds oni_small/.
TEST(OpenNi2Source, ReadsRealOniFiles) {
  const char* data = std::getenv("KINTSUGI_DATA");
  if (data == nullptr) GTEST_SKIP() << "KINTSUGI_DATA is not set";
  const fs::path folder = fs::path(data) / "oni_small";
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not there";
  const auto read = [&](const char* name) {
    const auto source = open_frame_source(config_of((folder / name).string()));
    auto frames = read_all(*source);
    EXPECT_TRUE(source->status().ended_well) << source->status().end_reason;
    EXPECT_EQ(source->status().counts.frames_dropped, 0);
    EXPECT_EQ(source->status().frames_total, static_cast<std::int64_t>(frames.size()));
    for (const RgbdFrame& frame : frames) {
      const double valid = cv::countNonZero(frame.depth_m == frame.depth_m);
      EXPECT_GT(valid, 0.3 * static_cast<double>(frame.depth_m.total()));
    }
    return frames;
  };
  EXPECT_EQ(read("3DJ_test.oni").size(), 12U);
  EXPECT_EQ(read("eranws_1.oni").size(), 24U);
}

}  // namespace
}  // namespace kintsugi::mapper
