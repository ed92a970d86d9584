#include <chrono>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

#include "mapper/process/frame_reader.hpp"

namespace kintsugi::mapper {
namespace {

using std::chrono::milliseconds;
constexpr milliseconds kLong{10'000};  ///< longer than anything here takes

/// Gives `count` numbered frames, then ends or throws.
class CountingSource : public FrameSource {
 public:
  CountingSource(int count, bool fails) : count_(count), fails_(fails) {}
  std::optional<RgbdFrame> next() override {
    if (given_ == count_) {
      if (fails_) throw std::runtime_error("the cable is out");
      return std::nullopt;
    }
    RgbdFrame frame;
    frame.frame_index = given_++;
    return frame;
  }
  SourceStatus status() const override {
    return {.name = "counting",
            .frames_total = count_,
            .counts = {.frames_delivered = given_},
            .end_reason = given_ == count_ ? "all counted" : ""};
  }

 private:
  int count_;
  bool fails_;
  int given_ = 0;
};

TEST(FrameReader, HandsOnEveryFrameInOrderAndThenTheEnd) {
  FrameReader reader(std::make_unique<CountingSource>(50, false));
  EXPECT_EQ(reader.status().name, "counting");
  EXPECT_EQ(reader.status().frames_total, 50);
  for (int i = 0; i < 50; ++i) {
    EXPECT_FALSE(reader.finished());
    const auto frame = reader.next(kLong);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->frame.frame_index, i);
    EXPECT_GE(frame->read_ms, 0.0);
    EXPECT_GE(frame->convert_ms, 0.0);
  }
  EXPECT_FALSE(reader.next(kLong));
  EXPECT_TRUE(reader.finished());
  EXPECT_TRUE(reader.status().ended_well);
  EXPECT_EQ(reader.status().end_reason, "all counted");
  EXPECT_EQ(reader.status().counts.frames_delivered, 50);
  EXPECT_NO_THROW(reader.rethrow_failure());
}

TEST(FrameReader, ReadsAheadAsFarAsItMayAndTellsHowManyWait) {
  FrameReader reader(std::make_unique<CountingSource>(10, false), 4);
  const auto deadline = std::chrono::steady_clock::now() + kLong;
  while (reader.status().counts.frames_delivered < 4 &&
         std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(milliseconds(1));
  }
  std::this_thread::sleep_for(milliseconds(20));
  EXPECT_EQ(reader.status().counts.frames_delivered, 4) << "and no further";
  EXPECT_EQ(reader.next(kLong)->num_waiting, 3U);
  int last = 0;
  while (const auto frame = reader.next(kLong)) {
    EXPECT_LT(frame->num_waiting, 4U);
    EXPECT_EQ(frame->frame.frame_index, ++last);
  }
  EXPECT_EQ(last, 9) << "none is lost";
}

TEST(FrameReader, KeepsAFailureForAfterTheFramesBeforeIt) {
  FrameReader reader(std::make_unique<CountingSource>(1, true));
  EXPECT_TRUE(reader.next(kLong));
  EXPECT_FALSE(reader.next(kLong));
  EXPECT_TRUE(reader.finished());
  EXPECT_FALSE(reader.status().ended_well);
  EXPECT_THROW(reader.rethrow_failure(), std::runtime_error);
}

TEST(FrameReader, CanBeLeftWithFramesUnread) {
  FrameReader reader(std::make_unique<CountingSource>(1000, false));
  EXPECT_TRUE(reader.next(kLong));
}

}  // namespace
}  // namespace kintsugi::mapper
