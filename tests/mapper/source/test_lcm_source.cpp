// Frames over LCM: through the codec and a log file, which LCM reads like a bus.

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/channels.hpp"
#include "lcmtypes/stream/stream_publisher.hpp"
#include "mapper/source/bus/rgbd_frame_encoder.hpp"
#include "mapper/source/open_source.hpp"
#include "tests/mapper/openni2_driver/recording_folder.hpp"

namespace kintsugi::mapper {
namespace {

constexpr std::int64_t kSession = 77;

RgbdFrame test_frame(int i) {
  RgbdFrame frame;
  frame.utime = 1'000'000 + 33'333 * i;
  frame.frame_index = i + 1;
  frame.intrinsics = {.fx = 50,
                      .fy = 51,
                      .cx = 31.5,
                      .cy = 23.5,
                      .width = test::kWidth,
                      .height = test::kHeight,
                      .distortion = {}};
  frame.depth_m.create(test::kHeight, test::kWidth);
  for (int y = 0; y < test::kHeight; ++y) {
    for (int x = 0; x < test::kWidth; ++x) {
      const int raw = test::raw_depth(i, x, y);
      frame.depth_m(y, x) = raw == 0 ? std::nanf("") : static_cast<float>(raw * 0.001);
    }
  }
  frame.color_rgb = test::color_image(i);
  return frame;
}

std::vector<RgbdFrameMessage> encoded_frames(int num, int jpeg_quality) {
  std::vector<RgbdFrameMessage> messages(static_cast<std::size_t>(num));
  std::ranges::generate(messages, [&, i = 0]() mutable {
    return encode_rgbd_frame(test_frame(i++), kSession, jpeg_quality);
  });
  return messages;
}

bool same_depth(const cv::Mat_<float>& a, const cv::Mat_<float>& b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](float x, float y) {
           return x == y || (std::isnan(x) && std::isnan(y));
         });
}

class FramesInALog : public testing::Test {
 protected:
  void write(const std::vector<RgbdFrameMessage>& messages) {
    Bus log("file://" + file_.string() + "?mode=w");
    StreamPublisher::Config config;
    config.rate_bytes_per_s = 1e9;
    StreamPublisher publisher(log, channels::kRgbdFrame, kSession, config);
    for (const auto& message : messages) publisher.publish(message);
    publisher.flush();
  }

  std::unique_ptr<FrameSource> open() {
    SourceConfig config;
    config.device = "lcm://RGBD_FRAME";
    config.lcm_url = "file://" + file_.string() + "?speed=0";
    config.replay = true;
    return open_frame_source(config);
  }

  test::RecordingFolder folder_;
  std::filesystem::path file_ = folder_.path() / "frames.lcmlog";
};

TEST_F(FramesInALog, ComeBackAsTheyWere) {
  write(encoded_frames(4, 0));
  const auto source = open();
  for (int i = 0; i < 4; ++i) {
    const auto frame = source->next();
    ASSERT_TRUE(frame) << source->status().end_reason;
    EXPECT_EQ(frame->utime, test_frame(i).utime);
    EXPECT_EQ(frame->frame_index, i + 1);
    EXPECT_EQ(frame->intrinsics, test_frame(i).intrinsics);
    EXPECT_TRUE(same_depth(frame->depth_m, test_frame(i).depth_m));
    EXPECT_EQ(cv::norm(frame->color_rgb, test::color_image(i), cv::NORM_INF), 0.0);
  }
  EXPECT_FALSE(source->next());
  EXPECT_EQ(source->status().end_reason, "end of the log");
  EXPECT_TRUE(source->status().ended_well);
}

TEST_F(FramesInALog, AreRefusedOneByOneWhenBad) {
  std::vector<RgbdFrameMessage> messages = encoded_frames(5, 90);
  messages[1].depth_png.resize(messages[1].depth_png.size() / 2);
  messages[2].utime = messages[0].utime;
  messages[2].color_utime = messages[0].utime;
  messages[3].color_jpeg.clear();
  write(messages);
  const auto source = open();
  std::vector<std::int64_t> indices;
  while (const auto frame = source->next()) indices.push_back(frame->frame_index);
  EXPECT_THAT(indices, testing::ElementsAre(1, 4, 5));
  EXPECT_EQ(source->status().counts.frames_bad, 2);
  EXPECT_EQ(source->status().counts.depth_unpaired, 1);
}

TEST(LcmSource, WantsAChannel) {
  SourceConfig config;
  config.device = "lcm://";
  EXPECT_THROW(open_frame_source(config), std::invalid_argument);
}

TEST(RgbdFrameEncoder, ReachesBeyondTheFineUnit) {
  RgbdFrame frame = test_frame(0);
  EXPECT_EQ(encode_rgbd_frame(frame, kSession, 0).depth_units_per_m, 10000.0);
  frame.depth_m(0, 1) = 12.0F;
  EXPECT_EQ(encode_rgbd_frame(frame, kSession, 0).depth_units_per_m, 5000.0);
  frame.color_rgb.release();
  EXPECT_TRUE(encode_rgbd_frame(frame, kSession, 0).color_jpeg.empty());
}

}  // namespace
}  // namespace kintsugi::mapper
