#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "mapper/source/frames/paced_source.hpp"
#include "tests/mapper/source/empty_recording.hpp"

namespace kintsugi::mapper {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;
using testing::EmptyRecording;
using testing::kPeriod_us;

bool never() { return false; }

TEST(PacedSource, GivesNoFrameBeforeItsTime) {
  PacedSource source(std::make_unique<EmptyRecording>(10), -1, never);
  const auto begin = Clock::now();
  while (const auto frame = source.next()) {
    EXPECT_GE(Clock::now() - begin, std::chrono::microseconds(frame->utime));
  }
  EXPECT_EQ(source.status().end_reason, "all given");
}

TEST(PacedSource, DropsWholeFramesWhenAskedTooLateAndCountsThem) {
  constexpr int kNumFrames = 80;
  PacedSource source(std::make_unique<EmptyRecording>(kNumFrames), -1, never);
  std::int64_t taken = 0;
  std::int64_t last_utime = -1;
  while (const auto frame = source.next()) {
    ++taken;
    EXPECT_GT(frame->utime, last_utime);
    last_utime = frame->utime;
    std::this_thread::sleep_for(milliseconds(50));
  }
  EXPECT_EQ(last_utime, (kNumFrames - 1) * kPeriod_us) << "the newest one stays";
  EXPECT_LE(taken, 24) << "of five in a row, one; and those that may wait at first and in the end";
  EXPECT_EQ(source.status().counts.frames_delivered, taken);
  EXPECT_EQ(source.status().counts.frames_dropped, kNumFrames - taken);
}

TEST(PacedSource, PlaysMoreSlowlyARecordingThatIsSlowToRead) {
  PacedSource source(std::make_unique<EmptyRecording>(20, milliseconds(20)), -1, never);
  std::int64_t taken = 0;
  while (source.next()) ++taken;
  EXPECT_EQ(taken + source.status().counts.frames_dropped, 20);
  EXPECT_GE(taken, 15) << "nearly all; on a busy machine the reader itself may come late";
}

TEST(PacedSource, HurriesThroughWhatWasMappedBeforeAndGivesAllOfIt) {
  PacedSource source(std::make_unique<EmptyRecording>(500), 497 * kPeriod_us, never);
  for (int i = 0; i < 498; ++i) EXPECT_EQ(source.next()->utime, i * kPeriod_us);
  EXPECT_EQ(source.status().counts.frames_dropped, 0);
}

/// The clock was set between them.
class TwoFramesYearsApart : public FrameSource {
 public:
  static constexpr std::int64_t kGap_us = 50LL * 365 * 86'400 * 1'000'000;

  std::optional<RgbdFrame> next() override {
    if (count_ == 2) return std::nullopt;
    RgbdFrame frame;
    frame.utime = kGap_us * count_;
    frame.frame_index = ++count_;
    return frame;
  }
  [[nodiscard]] SourceStatus status() const override { return {}; }

 private:
  int count_ = 0;
};

TEST(PacedSource, DoesNotWaitForAGapInTheRecordingAndSaysSo) {
  std::vector<std::string> said;
  PacedSource source(std::make_unique<TwoFramesYearsApart>(), -1, never,
                     [&](const SourceNotice& notice) { said.push_back(notice.text); });
  EXPECT_TRUE(source.next());
  EXPECT_TRUE(source.next());
  EXPECT_FALSE(source.next());
  ASSERT_EQ(said.size(), 1U);
  EXPECT_NE(said[0].find(" s before frame 2: not waited for"), std::string::npos) << said[0];
}

TEST(PacedSource, DoesNotWaitAnyMoreWhenItIsStopped) {
  PacedSource source(std::make_unique<EmptyRecording>(1'000'000), -1, [] { return true; });
  EXPECT_TRUE(source.next());
  EXPECT_TRUE(source.next());
}

}  // namespace
}  // namespace kintsugi::mapper
