// Frames over LCM: through the codec and a log file, which LCM reads like a bus.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/channels.hpp"
#include "lcmtypes/stream/stream_publisher.hpp"
#include "mapper/source/bus/rgbd_frame_encoder.hpp"
#include "mapper/source/open_source.hpp"
#include "tests/mapper/openni2_driver/recording_folder.hpp"
#include "tests/support/private_bus.hpp"

namespace kintsugi::mapper {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

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

class FramesInALog : public ::testing::Test {
 protected:
  void write(const std::vector<RgbdFrameMessage>& messages) {
    Bus log("file://" + file_.string() + "?mode=w");
    StreamPublisher::Config config;
    config.rate_bytes_per_s = 1e9;
    std::map<std::int64_t, StreamPublisher> publishers;  // by session
    for (const auto& message : messages) {
      const auto publisher = publishers.try_emplace(message.session, log, channels::kRgbdFrame,
                                                    message.session, config);
      publisher.first->second.publish(message);
      publisher.first->second.flush();
    }
  }

  std::unique_ptr<FrameSource> open() {
    SourceConfig config;
    config.device = "lcm://RGBD_FRAME";
    config.lcm_url = "file://" + file_.string() + "?speed=0";
    config.replay = true;
    config.notify = [this](const SourceNotice& notice) { said_.push_back(notice.text); };
    return open_frame_source(config);
  }

  test::RecordingFolder folder_;
  std::filesystem::path file_ = folder_.path() / "frames.lcmlog";
  std::vector<std::string> said_;
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
  EXPECT_THAT(indices, ElementsAre(1, 4, 5));
  EXPECT_EQ(source->status().counts.frames_bad, 2);
  EXPECT_EQ(source->status().counts.depth_unpaired, 1);
  ASSERT_EQ(said_.size(), 1U) << "the first";
  EXPECT_THAT(said_[0], HasSubstr("a frame on lcm://RGBD_FRAME is refused: "));
}

TEST_F(FramesInALog, OfAnotherSessionAreRefusedWithTheReason) {
  std::vector<RgbdFrameMessage> messages = encoded_frames(3, 90);
  messages[1].session = kSession + 1;
  write(messages);
  const auto source = open();
  while (source->next()) {
  }
  EXPECT_EQ(source->status().counts.frames_bad, 1);
  EXPECT_THAT(said_, ElementsAre(HasSubstr("it is of session 78, the frames before are of 77")));
}

/// Its frames are refused, so that the source would wait for ever.
TEST(LcmSource, EndsWhenItsSenderHasBegunAnew) {
  if (const auto why_not = kintsugi::testing::enter_private_bus()) GTEST_SKIP() << *why_not;
  SourceConfig config;
  config.device = "lcm://RGBD_FRAME";
  config.lcm_url = kintsugi::testing::kPrivateBusUrl;
  config.replay = true;
  config.lcm_silence_s = 0.5;
  const auto source = open_frame_source(config);
  std::atomic<bool> has_ended = false;
  std::thread sender([&] {
    Bus bus(kintsugi::testing::kPrivateBusUrl);
    for (std::int64_t session = kSession; !has_ended; ++session) {
      StreamPublisher publisher(bus, channels::kRgbdFrame, session, {});
      publisher.publish(encode_rgbd_frame(test_frame(0), session, 0));
      publisher.flush();
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  });
  EXPECT_TRUE(source->next());
  EXPECT_FALSE(source->next());
  has_ended = true;
  sender.join();
  EXPECT_THAT(source->status().end_reason,
              HasSubstr("no frame that can be used came on lcm://RGBD_FRAME"));
  EXPECT_GT(source->status().counts.frames_bad, 0);
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
