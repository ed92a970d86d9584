#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "segmenter/map/slice_sequencer.hpp"

namespace kintsugi::segmenter {
namespace {

using Verdict = SliceSequencer::Verdict;
using std::chrono::seconds;

CloudSlice slice(std::int32_t id, std::int32_t revision = 0) {
  CloudSlice result;
  result.id = id;
  result.revision = revision;
  return result;
}

class SliceSequencerTest : public ::testing::Test {
 protected:
  std::vector<std::int32_t> pop_all() {
    std::vector<std::int32_t> ids;
    while (const auto next = sequencer_.pop(now_)) {
      ids.push_back(next->id);
    }
    return ids;
  }

  using Ids = std::vector<std::int32_t>;
  SliceSequencer::Clock::time_point now_{seconds(1000)};
  SliceSequencer sequencer_{{.gap_timeout = seconds(10)}};
};

TEST_F(SliceSequencerTest, HandsOnEveryPermutationInOrder) {
  Ids order{0, 1, 2, 3, 4};
  do {
    sequencer_ = SliceSequencer({.gap_timeout = seconds(10)});
    Ids handed_on;
    for (const std::int32_t id : order) {
      EXPECT_EQ(sequencer_.offer(slice(id), now_), Verdict::kTaken);
      std::ranges::copy(pop_all(), std::back_inserter(handed_on));
    }
    EXPECT_EQ(handed_on, (Ids{0, 1, 2, 3, 4}));
    EXPECT_EQ(sequencer_.num_missing(), 0);
  } while (std::ranges::next_permutation(order).found);
}

TEST_F(SliceSequencerTest, WaitsForAMissingSliceUntilTheTimeout) {
  sequencer_.offer(slice(0), now_);
  sequencer_.offer(slice(3), now_);
  EXPECT_EQ(pop_all(), Ids{0});
  EXPECT_EQ(sequencer_.num_waiting(), 1);
  EXPECT_EQ(sequencer_.num_missing(), 2);
  now_ += seconds(9);
  EXPECT_FALSE(sequencer_.give_up_gap(now_, false));
  now_ += seconds(1);
  EXPECT_EQ(sequencer_.give_up_gap(now_, false), (SliceGap{1, 2}));
  EXPECT_EQ(pop_all(), Ids{3});
  EXPECT_EQ(sequencer_.num_given_up(), 2);
}

TEST_F(SliceSequencerTest, StartsTheTimeoutWhenSomethingBeginsToWait) {
  sequencer_.offer(slice(0), now_);
  EXPECT_EQ(pop_all(), Ids{0});
  now_ += seconds(100);  // the camera stood still
  sequencer_.offer(slice(2), now_);
  EXPECT_FALSE(sequencer_.give_up_gap(now_, false));
  sequencer_.offer(slice(1), now_);
  EXPECT_EQ(pop_all(), (Ids{1, 2}));
}

TEST_F(SliceSequencerTest, GivesUpGapsAtOnceWhenTheStreamHasEnded) {
  sequencer_.offer(slice(2), now_);
  sequencer_.offer(slice(4), now_);
  EXPECT_EQ(sequencer_.give_up_gap(now_, true), (SliceGap{0, 1}));
  EXPECT_EQ(pop_all(), Ids{2});
  EXPECT_EQ(sequencer_.give_up_gap(now_, true), (SliceGap{3, 3}));
  EXPECT_EQ(pop_all(), Ids{4});
  EXPECT_FALSE(sequencer_.give_up_gap(now_, true));
}

TEST_F(SliceSequencerTest, HandsOnASliceThatWasGivenUpWhenItComesAfterAll) {
  sequencer_.offer(slice(1), now_);
  sequencer_.give_up_gap(now_, true);
  EXPECT_EQ(pop_all(), Ids{1});
  EXPECT_EQ(sequencer_.num_given_up(), 1);
  EXPECT_EQ(sequencer_.offer(slice(0), now_), Verdict::kTaken);
  EXPECT_EQ(pop_all(), Ids{0});
  EXPECT_EQ(sequencer_.num_given_up(), 0);
  EXPECT_EQ(sequencer_.num_missing(), 0);
}

TEST_F(SliceSequencerTest, TellsDuplicatesFromCorrections) {
  sequencer_.offer(slice(1), now_);
  EXPECT_EQ(sequencer_.offer(slice(1), now_), Verdict::kDuplicate);
  EXPECT_EQ(sequencer_.offer(slice(1, 5), now_), Verdict::kReplaced);
  EXPECT_EQ(sequencer_.offer(slice(1, 4), now_), Verdict::kDuplicate);
  sequencer_.offer(slice(0), now_);
  ASSERT_EQ(sequencer_.pop(now_)->id, 0);
  EXPECT_EQ(sequencer_.pop(now_)->revision, 5);
  EXPECT_EQ(sequencer_.offer(slice(1, 5), now_), Verdict::kDuplicate);
  EXPECT_EQ(sequencer_.offer(slice(1, 6), now_), Verdict::kRevision);
}

TEST_F(SliceSequencerTest, SurvivesTheLargestId) {
  sequencer_.offer(slice(2147483647), now_);
  EXPECT_EQ(sequencer_.num_missing(), 2147483647);
  EXPECT_EQ(sequencer_.give_up_gap(now_, true), (SliceGap{0, 2147483646}));
  EXPECT_EQ(pop_all(), Ids{2147483647});
  EXPECT_FALSE(sequencer_.give_up_gap(now_, true));
}

TEST(SliceSequencerConfig, RefusesATimeoutThatIsNotPositive) {
  EXPECT_THROW(SliceSequencer({.gap_timeout = seconds(0)}), std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi::segmenter
