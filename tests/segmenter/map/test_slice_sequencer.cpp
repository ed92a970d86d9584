#include <algorithm>
#include <map>
#include <random>
#include <utility>
#include <vector>

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
    for (const auto& run : pop_runs()) {
      ids.insert(ids.end(), run.begin(), run.end());
    }
    return ids;
  }

  // Ids of each run.
  std::vector<std::vector<std::int32_t>> pop_runs(Outlook outlook = Outlook::kSilent) {
    std::vector<std::vector<std::int32_t>> runs;
    while (const auto run = sequencer_.pop(now_, outlook)) {
      EXPECT_TRUE(run->is_correction || run->slices.size() == 1);
      auto& ids = runs.emplace_back();
      for (const CloudSlice& slice : run->slices) {
        ids.push_back(slice.id);
      }
    }
    return runs;
  }

  using Ids = std::vector<std::int32_t>;
  SliceSequencer::Clock::time_point now_{seconds(1000)};
  using Runs = std::vector<Ids>;
  static constexpr SliceSequencer::Config kConfig{.gap_timeout = seconds(10),
                                                  .correction_quiet = seconds(1)};
  SliceSequencer sequencer_{kConfig};
};

TEST_F(SliceSequencerTest, HandsOnEveryPermutationInOrder) {
  Ids order{0, 1, 2, 3, 4};
  do {
    sequencer_ = SliceSequencer(kConfig);
    Ids handed_on;
    for (const std::int32_t id : order) {
      EXPECT_EQ(sequencer_.offer(slice(id), now_), Verdict::kTaken);
      std::ranges::copy(pop_all(), std::back_inserter(handed_on));
    }
    EXPECT_EQ(handed_on, (Ids{0, 1, 2, 3, 4}));
    EXPECT_EQ(sequencer_.num_missing(), 0);
  } while (std::ranges::next_permutation(order).found);
}

TEST_F(SliceSequencerTest, TellsWhatComesNext) {
  EXPECT_EQ(sequencer_.upcoming(), nullptr);
  sequencer_.offer(slice(1), now_);
  EXPECT_EQ(sequencer_.upcoming(), nullptr);  // waits for 0
  sequencer_.offer(slice(0), now_);
  ASSERT_NE(sequencer_.upcoming(), nullptr);
  EXPECT_EQ(sequencer_.upcoming()->id, 0);
  sequencer_.pop(now_, Outlook::kSilent);
  ASSERT_NE(sequencer_.upcoming(), nullptr);
  EXPECT_EQ(sequencer_.upcoming()->id, 1);
  sequencer_.offer(slice(0, 1), now_);
  sequencer_.pop(now_, Outlook::kSilent);
  EXPECT_EQ(sequencer_.upcoming(), nullptr);  // the correction comes first
}

TEST_F(SliceSequencerTest, WaitsForAMissingSliceUntilTheTimeout) {
  sequencer_.offer(slice(0), now_);
  sequencer_.offer(slice(3), now_);
  EXPECT_EQ(pop_all(), Ids{0});
  EXPECT_EQ(sequencer_.num_waiting(), 1);
  EXPECT_EQ(sequencer_.num_missing(), 2);
  now_ += seconds(9);
  EXPECT_FALSE(sequencer_.give_up_gap(now_, Outlook::kSilent));
  now_ += seconds(1);
  EXPECT_EQ(sequencer_.give_up_gap(now_, Outlook::kSilent), (SliceGap{1, 2}));
  EXPECT_EQ(pop_all(), Ids{3});
  EXPECT_EQ(sequencer_.num_given_up(), 2);
}

TEST_F(SliceSequencerTest, StartsTheTimeoutWhenSomethingBeginsToWait) {
  sequencer_.offer(slice(0), now_);
  EXPECT_EQ(pop_all(), Ids{0});
  now_ += seconds(100);  // the camera stood still
  sequencer_.offer(slice(2), now_);
  EXPECT_FALSE(sequencer_.give_up_gap(now_, Outlook::kSilent));
  sequencer_.offer(slice(1), now_);
  EXPECT_EQ(pop_all(), (Ids{1, 2}));
}

TEST_F(SliceSequencerTest, GivesUpGapsAtOnceWhenTheStreamHasEnded) {
  sequencer_.offer(slice(2), now_);
  sequencer_.offer(slice(4), now_);
  EXPECT_EQ(sequencer_.give_up_gap(now_, Outlook::kEnded), (SliceGap{0, 1}));
  EXPECT_EQ(pop_all(), Ids{2});
  EXPECT_EQ(sequencer_.give_up_gap(now_, Outlook::kEnded), (SliceGap{3, 3}));
  EXPECT_EQ(pop_all(), Ids{4});
  EXPECT_FALSE(sequencer_.give_up_gap(now_, Outlook::kEnded));
}

TEST_F(SliceSequencerTest, HandsOnASliceThatWasGivenUpWhenItComesAfterAll) {
  sequencer_.offer(slice(1), now_);
  sequencer_.give_up_gap(now_, Outlook::kEnded);
  EXPECT_EQ(pop_all(), Ids{1});
  EXPECT_EQ(sequencer_.num_given_up(), 1);
  EXPECT_EQ(sequencer_.offer(slice(0), now_), Verdict::kTaken);
  EXPECT_EQ(pop_all(), Ids{0});
  EXPECT_EQ(sequencer_.num_given_up(), 0);
  EXPECT_EQ(sequencer_.num_missing(), 0);
}

TEST_F(SliceSequencerTest, TellsDuplicatesFromRevisions) {
  sequencer_.offer(slice(1), now_);
  EXPECT_EQ(sequencer_.offer(slice(1), now_), Verdict::kDuplicate);
  EXPECT_EQ(sequencer_.offer(slice(1, 5), now_), Verdict::kReplaced);
  EXPECT_EQ(sequencer_.offer(slice(1, 4), now_), Verdict::kDuplicate);
  sequencer_.offer(slice(0), now_);
  ASSERT_EQ(sequencer_.pop(now_, Outlook::kSilent)->slices[0].id, 0);
  EXPECT_EQ(sequencer_.pop(now_, Outlook::kSilent)->slices[0].revision, 5);
  EXPECT_EQ(sequencer_.offer(slice(1, 5), now_), Verdict::kDuplicate);
  EXPECT_EQ(sequencer_.offer(slice(1, 7), now_), Verdict::kCorrected);
  EXPECT_EQ(sequencer_.offer(slice(1, 6), now_), Verdict::kDuplicate);
  EXPECT_EQ(sequencer_.num_waiting(), 1);
  const auto correction = sequencer_.pop(now_, Outlook::kEnded);
  ASSERT_TRUE(correction && correction->is_correction);
  EXPECT_EQ(correction->slices[0].revision, 7);
}

TEST_F(SliceSequencerTest, GathersCorrectionsIntoOneRunUntilTheyPause) {
  for (const std::int32_t id : {0, 1, 2, 3}) {
    sequencer_.offer(slice(id), now_);
  }
  EXPECT_EQ(pop_runs(), (Runs{{0}, {1}, {2}, {3}}));
  for (const std::int32_t id : {2, 0, 3}) {
    sequencer_.offer(slice(id, 1), now_);
    EXPECT_FALSE(sequencer_.pop(now_, Outlook::kSilent));
    now_ += std::chrono::milliseconds(900);
  }
  sequencer_.offer(slice(0, 2), now_);  // the newest stands for the slice
  EXPECT_EQ(sequencer_.num_waiting(), 3);
  now_ += seconds(1);
  const auto run = sequencer_.pop(now_, Outlook::kSilent);
  ASSERT_EQ(run->slices.size(), 3U);
  EXPECT_EQ(run->slices[0].id, 0);
  EXPECT_EQ(run->slices[0].revision, 2);
  EXPECT_EQ(run->slices[1].id, 2);
  EXPECT_EQ(run->slices[2].id, 3);
  EXPECT_EQ(sequencer_.num_waiting(), 0);
}

TEST_F(SliceSequencerTest, DoesNotWaitForeverForCorrectionsToPause) {
  sequencer_.offer(slice(0), now_);
  EXPECT_EQ(pop_all(), Ids{0});
  std::int32_t revision = 0;
  for (int tenth = 0; tenth < 100; ++tenth) {
    sequencer_.offer(slice(0, ++revision), now_);
    EXPECT_FALSE(sequencer_.pop(now_, Outlook::kSilent));
    now_ += std::chrono::milliseconds(100);
  }
  EXPECT_EQ(sequencer_.pop(now_, Outlook::kSilent)->slices[0].revision, 100);
}

TEST_F(SliceSequencerTest, PutsCorrectionsBehindWhatIsReadyAndBeforeWhatComesLater) {
  sequencer_.offer(slice(0), now_);
  sequencer_.offer(slice(1), now_);
  sequencer_.offer(slice(0, 1), now_);  // 0 was not fetched: its turn had come all the same
  sequencer_.offer(slice(1, 1), now_);
  sequencer_.offer(slice(3), now_);     // waits for 2
  sequencer_.offer(slice(0, 2), now_);  // still the same run
  sequencer_.offer(slice(2), now_);
  sequencer_.offer(slice(3, 1), now_);
  EXPECT_EQ(pop_runs(), (Runs{{0}, {1}, {0, 1}, {2}, {3}}));
  EXPECT_EQ(sequencer_.num_waiting(), 1);
  EXPECT_EQ(pop_runs(Outlook::kEnded), Runs{{3}});
}

TEST_F(SliceSequencerTest, RunsDependOnTheOrderOfArrivalAndNotOnWhenTheyAreFetched) {
  std::mt19937 random(3);
  for (int round = 0; round < 50; ++round) {
    std::vector<CloudSlice> arrivals;
    for (std::int32_t revision = 0; revision < 3; ++revision) {
      for (std::int32_t id = 0; id < 8; ++id) {
        arrivals.push_back(slice(id, revision));
      }
    }
    std::ranges::shuffle(arrivals, random);
    const auto runs_when_fetched_after_each = [&](int one_in) {
      sequencer_ = SliceSequencer(kConfig);
      Runs runs;
      for (const CloudSlice& arrival : arrivals) {
        sequencer_.offer(arrival, now_);
        if (one_in > 0 && static_cast<int>(random() % 3) < one_in) {
          std::ranges::move(pop_runs(), std::back_inserter(runs));
        }
      }
      std::ranges::move(pop_runs(Outlook::kEnded), std::back_inserter(runs));
      EXPECT_EQ(sequencer_.num_waiting(), 0);
      EXPECT_EQ(sequencer_.num_missing(), 0);
      return runs;
    };
    const Runs expected = runs_when_fetched_after_each(0);
    EXPECT_EQ(runs_when_fetched_after_each(1), expected);
    EXPECT_EQ(runs_when_fetched_after_each(3), expected);
  }
}

TEST_F(SliceSequencerTest, GoesOnWhereAnEarlierSegmenterStopped) {
  sequencer_ = SliceSequencer(kConfig, {.revisions = {{0, 0}, {1, 2}, {3, 0}}});
  EXPECT_EQ(sequencer_.num_given_up(), 1);
  EXPECT_EQ(sequencer_.num_missing(), 1);
  EXPECT_EQ(sequencer_.offer(slice(0), now_), Verdict::kDuplicate);
  EXPECT_EQ(sequencer_.offer(slice(1, 2), now_), Verdict::kDuplicate);
  EXPECT_EQ(sequencer_.offer(slice(1, 3), now_), Verdict::kCorrected);
  EXPECT_EQ(sequencer_.offer(slice(4), now_), Verdict::kTaken);
  EXPECT_EQ(sequencer_.offer(slice(2), now_), Verdict::kTaken);
  EXPECT_EQ(pop_runs(), (Runs{{1}, {4}, {2}}));
  EXPECT_EQ(sequencer_.num_missing(), 0);
}

TEST_F(SliceSequencerTest, SurvivesTheLargestId) {
  sequencer_.offer(slice(2147483647), now_);
  EXPECT_EQ(sequencer_.num_missing(), 2147483647);
  EXPECT_EQ(sequencer_.give_up_gap(now_, Outlook::kEnded), (SliceGap{0, 2147483646}));
  EXPECT_EQ(pop_all(), Ids{2147483647});
  EXPECT_FALSE(sequencer_.give_up_gap(now_, Outlook::kEnded));
}

// Patches.

class PatchBatches : public SliceSequencerTest {
 protected:
  /// A patch of the batch of time `utime`.
  static CloudSlice patch(std::int64_t utime, std::int32_t id, std::int32_t revision = 0,
                          bool ends_batch = false) {
    CloudSlice result = slice(id, revision);
    result.utime = utime;
    result.kind = SliceKind::kPatch;
    result.ends_batch = ends_batch;
    return result;
  }
  static CloudSlice last_patch(std::int64_t utime, std::int32_t id, std::int32_t revision = 0) {
    return patch(utime, id, revision, true);
  }
  static CloudSlice final_slice(std::int64_t utime, std::int32_t id, std::int64_t revision_sum) {
    CloudSlice result = slice(id);
    result.utime = utime;
    result.revision_sum = revision_sum;
    return result;
  }
  /// {id, revision} of each slice of each group.
  using Group = std::vector<std::pair<std::int32_t, std::int32_t>>;
  std::vector<Group> pop_groups(Outlook outlook = Outlook::kSilent) {
    std::vector<Group> groups;
    while (const auto group = sequencer_.pop(now_, outlook)) {
      EXPECT_FALSE(group->is_correction);
      groups.emplace_back();
      for (const CloudSlice& slice : group->slices) {
        groups.back().emplace_back(slice.id, slice.revision);
      }
    }
    return groups;
  }
  void make_live() {
    SliceSequencer::Config config = kConfig;
    config.is_live = true;
    sequencer_ = SliceSequencer(config);
  }
  using Groups = std::vector<Group>;
};

TEST_F(PatchBatches, AreWhatComesUpToTheEnd) {
  EXPECT_EQ(sequencer_.offer(patch(1, 0), now_), Verdict::kTaken);
  EXPECT_EQ(sequencer_.offer(patch(1, 2), now_), Verdict::kTaken);
  EXPECT_EQ(pop_groups(), Groups{});
  sequencer_.offer(last_patch(1, 1), now_);
  EXPECT_EQ(sequencer_.upcoming(), nullptr);
  EXPECT_EQ(pop_groups(), (Groups{{{0, 0}, {1, 0}, {2, 0}}}));
  EXPECT_EQ(sequencer_.offer(patch(2, 1, 3), now_), Verdict::kCorrected);
  sequencer_.offer(patch(2, 3), now_);
  EXPECT_EQ(pop_groups(), Groups{});
  sequencer_.offer(last_patch(2, 0, 1), now_);
  EXPECT_EQ(pop_groups(), (Groups{{{0, 1}, {1, 3}, {3, 0}}}));
  EXPECT_EQ(sequencer_.num_waiting(), 0);
  EXPECT_EQ(sequencer_.num_missing(), 0);
}

TEST_F(PatchBatches, DoNotWaitForMissingIds) {
  sequencer_.offer(last_patch(1, 5), now_);
  EXPECT_EQ(pop_groups(), (Groups{{{5, 0}}}));
  EXPECT_EQ(sequencer_.num_missing(), 5);
  EXPECT_EQ(sequencer_.num_given_up(), 0);
}

TEST_F(PatchBatches, StayApartUnlessLive) {
  const auto offer_three = [&] {
    sequencer_.offer(last_patch(1, 0), now_);
    sequencer_.offer(patch(2, 0, 1), now_);
    sequencer_.offer(last_patch(2, 1), now_);
    sequencer_.offer(last_patch(3, 0, 2), now_);
    sequencer_.offer(patch(4, 1, 1), now_);
  };
  offer_three();
  EXPECT_EQ(sequencer_.num_waiting(), 5);
  EXPECT_EQ(pop_groups(), (Groups{{{0, 0}}, {{0, 1}, {1, 0}}, {{0, 2}}}));
  make_live();
  offer_three();
  EXPECT_EQ(pop_groups(), (Groups{{{0, 2}, {1, 0}}}));
  EXPECT_EQ(sequencer_.num_waiting(), 1);
  EXPECT_EQ(sequencer_.waiting_bytes(), sizeof(CloudSlice));
}

TEST_F(PatchBatches, EndWithTheNextEndWhereTheirOwnWasLost) {
  sequencer_.offer(patch(1, 0), now_);
  sequencer_.offer(patch(1, 1), now_);
  sequencer_.offer(patch(2, 0, 1), now_);
  sequencer_.offer(last_patch(2, 2), now_);
  EXPECT_EQ(pop_groups(), (Groups{{{0, 1}, {1, 0}, {2, 0}}}));
}

TEST_F(PatchBatches, EndWithAPauseWhenLiveAndWithALongOneInALog) {
  sequencer_.offer(patch(1, 0), now_);
  now_ += seconds(9);
  EXPECT_EQ(pop_groups(), Groups{});
  now_ += seconds(1);
  EXPECT_EQ(pop_groups(), (Groups{{{0, 0}}}));
  make_live();
  sequencer_.offer(patch(1, 0), now_);
  EXPECT_EQ(pop_groups(), Groups{});
  now_ += seconds(1);
  EXPECT_EQ(pop_groups(), (Groups{{{0, 0}}}));
}

TEST_F(PatchBatches, APatchThatComesAfterTheEndOfItsBatchWaitsForNothing) {
  sequencer_.offer(patch(1, 0), now_);
  sequencer_.offer(last_patch(1, 2), now_);
  sequencer_.offer(patch(2, 3), now_);
  sequencer_.offer(patch(1, 1), now_);  // was sent again
  sequencer_.offer(last_patch(2, 4), now_);
  EXPECT_EQ(pop_groups(), (Groups{{{0, 0}, {2, 0}}, {{3, 0}}, {{1, 0}}, {{4, 0}}}));
}

TEST_F(PatchBatches, TheFinalSliceEndsThemAndWaitsForEveryIdAndRevision) {
  sequencer_.offer(last_patch(1, 0), now_);
  sequencer_.offer(patch(2, 0, 1), now_);
  sequencer_.offer(final_slice(3, 2, 4), now_);
  EXPECT_EQ(pop_groups(), (Groups{{{0, 0}}, {{0, 1}}}));
  EXPECT_EQ(sequencer_.num_waiting(), 1);
  sequencer_.offer(patch(2, 1, 1), now_);
  EXPECT_EQ(pop_groups(), (Groups{{{1, 1}}}));
  EXPECT_FALSE(sequencer_.give_up_gap(now_, Outlook::kSilent));
  sequencer_.offer(patch(2, 0, 3), now_);
  EXPECT_EQ(pop_groups(), (Groups{{{0, 3}}, {{2, 0}}}));
  EXPECT_EQ(sequencer_.num_given_up(), 0);
}

TEST_F(PatchBatches, MissingRevisionsAreGivenUpAsMissingSlicesAre) {
  sequencer_.offer(last_patch(1, 1), now_);
  sequencer_.offer(final_slice(3, 4, 7), now_);
  EXPECT_EQ(pop_groups(), (Groups{{{1, 0}}}));
  now_ += seconds(9);
  EXPECT_FALSE(sequencer_.give_up_gap(now_, Outlook::kSilent));
  now_ += seconds(1);
  EXPECT_FALSE(sequencer_.give_up_gap(now_, Outlook::kLive));
  EXPECT_EQ(sequencer_.give_up_gap(now_, Outlook::kSilent), (SliceGap{0, 0}));
  EXPECT_EQ(sequencer_.give_up_gap(now_, Outlook::kSilent), (SliceGap{2, 3}));
  EXPECT_EQ(pop_groups(), Groups{});
  EXPECT_EQ(sequencer_.give_up_gap(now_, Outlook::kSilent)->num_revisions, 7);
  EXPECT_EQ(pop_groups(), (Groups{{{4, 0}}}));
  EXPECT_EQ(sequencer_.num_given_up(), 3);
  for (const std::int32_t id : {0, 2, 3}) sequencer_.offer(patch(2, id, 2), now_);
  EXPECT_EQ(sequencer_.num_given_up(), 1);  // some slice is not the newest
  sequencer_.offer(patch(2, 1, 1), now_);
  EXPECT_EQ(sequencer_.num_given_up(), 0);
}

TEST_F(PatchBatches, AResumedMapWaitsForThePatchesThatItLacks) {
  sequencer_ = SliceSequencer(kConfig, {.revisions = {{0, 2}, {3, 0}}, .has_patches = true});
  EXPECT_EQ(sequencer_.num_given_up(), 0);
  sequencer_.offer(final_slice(9, 4, 3), now_);
  EXPECT_EQ(pop_groups(), Groups{});
  sequencer_.offer(patch(5, 1), now_);
  sequencer_.offer(patch(5, 2, 1), now_);
  EXPECT_EQ(pop_groups(), (Groups{{{1, 0}}, {{2, 1}}, {{4, 0}}}));
}

TEST_F(PatchBatches, TellWhichChunksNeedNotBeSentAgain) {
  const auto chunk = [](CloudSlice slice, std::int64_t sequence) {
    slice.sequence = sequence;
    slice.num_chunks = 2;
    return slice;
  };
  using Ranges = std::vector<SequenceRange>;
  make_live();
  sequencer_.offer(chunk(patch(1, 0, 1), 10), now_);
  sequencer_.offer(chunk(patch(1, 0, 0), 4), now_);        // older than what waits
  sequencer_.offer(chunk(last_patch(2, 0, 2), 20), now_);  // replaces it
  sequencer_.offer(chunk(last_patch(3, 0, 3), 30), now_);  // so does the next batch
  EXPECT_EQ(sequencer_.pop(now_, Outlook::kSilent)->superseded,
            (Ranges{{4, 5}, {10, 11}, {20, 21}}));
  sequencer_.offer(chunk(patch(1, 0, 1), 10), now_);
  sequencer_.offer(chunk(last_patch(4, 1), 40), now_);
  EXPECT_EQ(sequencer_.pop(now_, Outlook::kSilent)->superseded, (Ranges{{10, 11}}));
}

TEST_F(PatchBatches, ACorrectionOfTheMapIsAGroupOfItsOwnThatWaitsForNothing) {
  const auto correction = [](std::int32_t id) {
    CloudSlice slice = patch(1, id, 0);
    slice.kind = SliceKind::kCorrection;
    slice.correction = 1;
    slice.ends_batch = true;
    return slice;
  };
  EXPECT_EQ(sequencer_.offer(patch(1, 0, 0), now_), SliceSequencer::Verdict::kTaken);
  EXPECT_EQ(sequencer_.offer(correction(7), now_), SliceSequencer::Verdict::kTaken);
  EXPECT_EQ(sequencer_.offer(correction(7), now_), SliceSequencer::Verdict::kDuplicate);
  EXPECT_EQ(sequencer_.offer(patch(1, 1, 0), now_), SliceSequencer::Verdict::kTaken);
  EXPECT_EQ(sequencer_.pop(now_, Outlook::kLive)->slices.front().id, 0) << "as it was before it";
  const auto group = sequencer_.pop(now_, Outlook::kLive);
  ASSERT_TRUE(group);
  ASSERT_EQ(group->slices.size(), 1U);
  EXPECT_EQ(group->slices.front().kind, SliceKind::kCorrection);
  EXPECT_FALSE(sequencer_.pop(now_, Outlook::kLive)) << "the batch after it is not complete";
}

// A stream in which messages are lost and sent again, doubled and out of order: every patch comes
// out in its newest revision, none goes back to an older one, and the final slice comes last.
TEST_F(PatchBatches, ComeOutInTheirNewestRevisionsWhateverTheOrder) {
  std::mt19937 random(5);
  for (int round = 0; round < 300; ++round) {
    constexpr std::int32_t kPatches = 12;
    std::vector<CloudSlice> stream;
    std::map<std::int32_t, std::int32_t> newest;
    for (std::int64_t utime = 1; utime <= 10; ++utime) {
      for (std::int32_t id = 0; id < kPatches; ++id) {
        if (utime < 10 && random() % 3 != 0) continue;
        const auto known = newest.find(id);
        newest[id] = known == newest.end() ? 0 : known->second + 1 + static_cast<int>(random() % 2);
        stream.push_back(patch(utime, id, newest[id]));
      }
      if (!stream.empty()) stream.back().ends_batch = random() % 4 != 0;
    }
    std::int64_t revision_sum = 0;
    for (const auto& [id, revision] : newest) revision_sum += revision;
    stream.push_back(final_slice(11, kPatches, revision_sum));
    for (std::size_t i = stream.size(); i > 0; --i) {  // some again
      if (random() % 3 == 0) stream.push_back(stream[random() % stream.size()]);
    }
    for (std::size_t i = 0; i < stream.size(); ++i) {  // late by a few places
      std::swap(stream[i], stream[std::min(i + random() % 6, stream.size() - 1)]);
    }
    if (round % 2 == 0)
      make_live();
    else
      sequencer_ = SliceSequencer(kConfig);
    std::map<std::int32_t, std::int32_t> popped;
    const auto pop_some = [&](Outlook outlook) {
      while (const auto group = sequencer_.pop(now_, outlook)) {
        EXPECT_FALSE(popped.contains(kPatches)) << "something comes after the final slice";
        for (const CloudSlice& slice : group->slices) {
          const auto [known, is_new] = popped.try_emplace(slice.id, slice.revision);
          EXPECT_TRUE(is_new || slice.revision > known->second);
          known->second = slice.revision;
        }
      }
    };
    for (const CloudSlice& slice : stream) {
      sequencer_.offer(slice, now_);
      if (random() % 3 == 0) pop_some(Outlook::kSilent);
    }
    pop_some(Outlook::kEnded);
    newest[kPatches] = 0;
    EXPECT_EQ(popped, newest);
    EXPECT_EQ(sequencer_.num_waiting(), 0);
    EXPECT_EQ(sequencer_.num_missing(), 0);
    EXPECT_EQ(sequencer_.num_given_up(), 0);
    EXPECT_EQ(sequencer_.waiting_bytes(), 0U);
  }
}

TEST(SliceSequencerConfig, RefusesATimeThatIsNotPositive) {
  EXPECT_THROW(SliceSequencer({.gap_timeout = seconds(0)}), std::invalid_argument);
  EXPECT_THROW(SliceSequencer({.correction_quiet = seconds(0)}), std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi::segmenter
