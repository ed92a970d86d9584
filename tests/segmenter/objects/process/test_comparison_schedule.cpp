#include <gtest/gtest.h>

#include "segmenter/objects/process/comparison_schedule.hpp"

namespace kintsugi::segmenter {
namespace {

using std::chrono::seconds;

class Schedule : public ::testing::Test {
 protected:
  ComparisonSchedule schedule_{seconds(5)};
  ComparisonSchedule::Clock::time_point start_{seconds(100)};
};

TEST_F(Schedule, ComparesAMapThatGrowsNowAndThen) {
  EXPECT_FALSE(schedule_.is_due(false, start_));
  schedule_.note_news();
  EXPECT_TRUE(schedule_.is_due(false, start_));
  schedule_.begin(false, start_);
  EXPECT_FALSE(schedule_.is_due(false, start_ + seconds(9)));
  schedule_.note_news();
  EXPECT_FALSE(schedule_.is_due(false, start_ + seconds(4)));
  EXPECT_TRUE(schedule_.is_due(false, start_ + seconds(5)));
}

TEST_F(Schedule, ComparesACompleteMapWithoutNews) {
  schedule_.note_news();
  schedule_.begin(false, start_);
  EXPECT_TRUE(schedule_.is_due(true, start_));
  schedule_.begin(true, start_);
  EXPECT_FALSE(schedule_.is_due(true, start_ + seconds(60)));
  schedule_.note_news();
  EXPECT_TRUE(schedule_.is_due(true, start_));
}

TEST_F(Schedule, BeginsAgainWithAMapThatGoesOn) {
  schedule_.begin(true, start_);
  schedule_.note_news();
  EXPECT_TRUE(schedule_.is_due(false, start_ + seconds(5)));
  schedule_.begin(false, start_ + seconds(5));
  EXPECT_TRUE(schedule_.is_due(true, start_ + seconds(6)));
}

}  // namespace
}  // namespace kintsugi::segmenter
