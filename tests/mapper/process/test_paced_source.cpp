#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "mapper/process/paced_source.hpp"
#include "mapper/session/resumed_source.hpp"

namespace kintsugi::mapper {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;
constexpr std::int64_t kPeriod_us = 10'000;

/// Frame i at i periods, as fast as asked.
class Recording : public FrameSource {
 public:
  explicit Recording(int count, milliseconds effort = milliseconds(0))
      : count_(count), effort_(effort) {}
  std::optional<RgbdFrame> next() override {
    if (given_ == count_) return std::nullopt;
    if (effort_ > milliseconds(0)) std::this_thread::sleep_for(effort_);
    RgbdFrame frame;
    frame.frame_index = given_;
    frame.utime = kPeriod_us * given_++;
    return frame;
  }
  std::int64_t frames_total() const override { return count_; }
  std::string name() const override { return "recording"; }
  SourceCounts counts() const override { return {.frames_delivered = given_}; }
  std::string end_reason() const override { return given_ == count_ ? "all given" : ""; }
  bool ended_well() const override { return true; }

 private:
  int count_;
  milliseconds effort_;
  int given_ = 0;
};

bool never() { return false; }

TEST(PacedSource, GivesNoFrameBeforeItsTime) {
  PacedSource source(std::make_unique<Recording>(10), -1, never);
  const auto begin = Clock::now();
  while (const auto frame = source.next()) {
    EXPECT_GE(Clock::now() - begin, std::chrono::microseconds(frame->utime));
  }
  EXPECT_EQ(source.end_reason(), "all given");
}

TEST(PacedSource, DropsWholeFramesWhenAskedTooLateAndCountsThem) {
  PacedSource source(std::make_unique<Recording>(40), -1, never);
  std::int64_t taken = 0;
  std::int64_t last_utime = -1;
  while (const auto frame = source.next()) {
    ++taken;
    EXPECT_GT(frame->utime, last_utime);
    last_utime = frame->utime;
    std::this_thread::sleep_for(milliseconds(50));
  }
  EXPECT_EQ(last_utime, 39 * kPeriod_us) << "the newest one stays";
  EXPECT_LE(taken, 12) << "of five in a row, one; and some leave for the first and the last";
  EXPECT_EQ(source.counts().frames_delivered, taken);
  EXPECT_EQ(source.counts().frames_dropped, 40 - taken);
}

TEST(PacedSource, PlaysMoreSlowlyARecordingThatIsSlowToRead) {
  PacedSource source(std::make_unique<Recording>(20, milliseconds(20)), -1, never);
  std::int64_t taken = 0;
  while (source.next()) ++taken;
  EXPECT_EQ(taken + source.counts().frames_dropped, 20);
  EXPECT_GE(taken, 15) << "nearly all; on a busy machine the reader itself may come late";
}

TEST(PacedSource, HurriesThroughWhatWasMappedBeforeAndGivesAllOfIt) {
  PacedSource source(std::make_unique<Recording>(500), 497 * kPeriod_us, never);
  for (int i = 0; i < 498; ++i) EXPECT_EQ(source.next()->utime, i * kPeriod_us);
  EXPECT_EQ(source.counts().frames_dropped, 0);
}

TEST(PacedSource, DoesNotWaitAnyMoreWhenItIsStopped) {
  PacedSource source(std::make_unique<Recording>(1'000'000), -1, [] { return true; });
  EXPECT_TRUE(source.next());
  EXPECT_TRUE(source.next());
}

TEST(ResumedSource, GivesTheFramesThatWereMappedThenAndEachThereafter) {
  ResumedSource source(std::make_unique<Recording>(10), {10'000, 30'000, 40'000}, false);
  std::vector<std::int64_t> indices;
  while (const auto frame = source.next()) indices.push_back(frame->frame_index);
  EXPECT_EQ(indices, (std::vector<std::int64_t>{1, 3, 4, 5, 6, 7, 8, 9}));
  EXPECT_EQ(source.counts().frames_delivered, 8);
  EXPECT_EQ(source.counts().frames_dropped, 2);
  EXPECT_EQ(source.end_reason(), "all given");
}

TEST(ResumedSource, EndsWhereTheSessionWasBeingEnded) {
  ResumedSource source(std::make_unique<Recording>(10), {0, 10'000}, true);
  EXPECT_TRUE(source.next());
  EXPECT_TRUE(source.next());
  EXPECT_FALSE(source.next());
  EXPECT_TRUE(source.ended_well());
  EXPECT_EQ(source.end_reason(), "the session was ended here");
}

TEST(ResumedSource, RefusesARecordingWithoutAFrameThatWasMapped) {
  ResumedSource source(std::make_unique<Recording>(10), {0, 12'345}, false);
  EXPECT_TRUE(source.next());
  EXPECT_THROW(source.next(), std::runtime_error);
}

}  // namespace
}  // namespace kintsugi::mapper
