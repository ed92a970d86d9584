#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/source/frames/frame_pairer.hpp"

namespace kintsugi::mapper {
namespace {

constexpr std::int64_t kPeriod_us = 33'333;

class Pairing : public testing::Test {
 protected:
  void depth(std::int64_t utime) {
    pairer_.add_depth(utime, utime / 1000, cv::Mat_<std::uint16_t>(1, 1));
  }
  void color(std::int64_t utime, int mark) {
    pairer_.add_color(utime, cv::Mat_<cv::Vec3b>(1, 1, cv::Vec3b::all(static_cast<uchar>(mark))));
  }
  /// Times of the frames decided so far, and the marks of their colours (0: none).
  std::vector<std::pair<std::int64_t, int>> taken() {
    std::vector<std::pair<std::int64_t, int>> frames;
    while (const auto frame = pairer_.take()) {
      frames.emplace_back(frame->utime, frame->color_rgb.empty() ? 0 : frame->color_rgb(0, 0)[0]);
    }
    return frames;
  }

  FramePairer pairer_{true, kPeriod_us};
};

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

TEST_F(Pairing, JoinsTheNearestOfBothSides) {
  color(95'000, 1);
  depth(100'000);
  EXPECT_THAT(taken(), IsEmpty()) << "a nearer colour may follow";
  color(102'000, 2);
  EXPECT_THAT(taken(), ElementsAre(Pair(100'000, 2)));
  EXPECT_EQ(pairer_.color_unpaired(), 1);
  EXPECT_EQ(pairer_.depth_unpaired(), 0);
}

TEST_F(Pairing, AcceptsHalfAPeriodAndAFifthAndNoMore) {
  depth(100'000);
  color(119'999, 1);
  depth(200'000);
  color(220'000, 2);
  EXPECT_THAT(taken(), ElementsAre(Pair(100'000, 1), Pair(200'000, 0)));
  EXPECT_EQ(pairer_.depth_unpaired(), 1);
  pairer_.finish();
  EXPECT_THAT(taken(), IsEmpty());
  EXPECT_EQ(pairer_.color_unpaired(), 1);
}

TEST_F(Pairing, GivesAColourAwayOnce) {
  color(100'000, 1);
  depth(100'000);
  depth(110'000);
  color(140'000, 2);
  EXPECT_THAT(taken(), ElementsAre(Pair(100'000, 1), Pair(110'000, 0)));
}

TEST_F(Pairing, DoesNotWaitForAColourStreamThatIsSilent) {
  depth(100'000);
  depth(133'000);
  EXPECT_THAT(taken(), IsEmpty());
  depth(166'000);
  EXPECT_THAT(taken(), ElementsAre(Pair(100'000, 0)));
  pairer_.finish();
  EXPECT_THAT(taken(), ElementsAre(Pair(133'000, 0), Pair(166'000, 0)));
}

TEST_F(Pairing, CountsColoursWithoutDepth) {
  for (int i = 0; i < 5; ++i) color(std::int64_t{33'000} * i, i + 1);
  depth(132'000);
  EXPECT_THAT(taken(), ElementsAre(Pair(132'000, 5)));
  EXPECT_EQ(pairer_.color_unpaired(), 4);
}

TEST_F(Pairing, GivesASlowColourToTheNearestDepthOnly) {
  for (int i = 0; i < 6; ++i) {
    depth(std::int64_t{33'333} * i);
    if (i % 2 == 1) color(std::int64_t{33'333} * i + 5'000, i);
  }
  pairer_.finish();
  EXPECT_THAT(taken(), ElementsAre(Pair(0, 0), Pair(33'333, 1), Pair(66'666, 0), Pair(99'999, 3),
                                   Pair(133'332, 0), Pair(166'665, 5)));
}

TEST_F(Pairing, GoesOnWhenColourComesBack) {
  for (int i = 0; i < 12; ++i) {
    depth(std::int64_t{33'333} * i);
    if (i < 3 || i > 8) color(std::int64_t{33'333} * i, i + 1);
  }
  pairer_.finish();
  const auto frames = taken();
  ASSERT_EQ(frames.size(), 12U);
  for (int i = 0; i < 12; ++i) {
    EXPECT_EQ(frames[static_cast<std::size_t>(i)].second, i < 3 || i > 8 ? i + 1 : 0);
  }
  EXPECT_EQ(pairer_.depth_unpaired(), 6);
}

TEST_F(Pairing, KeepsFewColoursWhenDepthFallsSilent) {
  for (int i = 0; i < 100; ++i) color(std::int64_t{33'333} * i, 1);
  EXPECT_EQ(pairer_.color_unpaired(), 92);
}

TEST_F(Pairing, StartsAgainAfterAnInterruption) {
  depth(100'000);
  color(90'000, 1);
  depth(133'000);
  pairer_.finish();
  EXPECT_THAT(taken(), ElementsAre(Pair(100'000, 1), Pair(133'000, 0)));
  pairer_.resume(true);
  depth(500'000);
  EXPECT_THAT(taken(), IsEmpty()) << "a colour may follow";
  color(500'000, 2);
  EXPECT_THAT(taken(), ElementsAre(Pair(500'000, 2)));
}

TEST_F(Pairing, ForgetsColoursOfAClockThatWasWrong) {
  color(9'000'000, 1);
  color(100'000, 2);
  depth(100'000);
  EXPECT_THAT(taken(), ElementsAre(Pair(100'000, 2)));
  EXPECT_EQ(pairer_.color_unpaired(), 1);
}

TEST(DepthAlone, IsDecidedAtOnce) {
  FramePairer pairer(false, kPeriod_us);
  pairer.add_depth(1, 1, cv::Mat_<std::uint16_t>(1, 1));
  EXPECT_TRUE(pairer.take());
  EXPECT_FALSE(pairer.take());
}

}  // namespace
}  // namespace kintsugi::mapper
