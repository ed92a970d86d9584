#include <stdexcept>

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
  std::int64_t frames_total() const override { return count_; }
  std::string name() const override { return "counting"; }
  SourceCounts counts() const override { return {.frames_delivered = given_}; }
  std::string end_reason() const override { return given_ == count_ ? "all counted" : ""; }
  bool ended_well() const override { return true; }

 private:
  int count_;
  bool fails_;
  int given_ = 0;
};

TEST(FrameReader, HandsOnEveryFrameInOrderAndThenTheEnd) {
  FrameReader reader(std::make_unique<CountingSource>(50, false));
  EXPECT_EQ(reader.device_name(), "counting");
  EXPECT_EQ(reader.frames_total(), 50);
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
  EXPECT_TRUE(reader.ended_well());
  EXPECT_EQ(reader.end_reason(), "all counted");
  EXPECT_EQ(reader.counts().frames_delivered, 50);
  EXPECT_NO_THROW(reader.rethrow_failure());
}

TEST(FrameReader, KeepsAFailureForAfterTheFramesBeforeIt) {
  FrameReader reader(std::make_unique<CountingSource>(1, true));
  EXPECT_TRUE(reader.next(kLong));
  EXPECT_FALSE(reader.next(kLong));
  EXPECT_TRUE(reader.finished());
  EXPECT_FALSE(reader.ended_well());
  EXPECT_THROW(reader.rethrow_failure(), std::runtime_error);
}

TEST(FrameReader, CanBeLeftWithFramesUnread) {
  FrameReader reader(std::make_unique<CountingSource>(1000, false));
  EXPECT_TRUE(reader.next(kLong));
}

}  // namespace
}  // namespace kintsugi::mapper
