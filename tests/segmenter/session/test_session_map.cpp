// One mapper session without threads and bus: slices in, updates and save requests out.

#include <algorithm>
#include <iterator>
#include <map>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "segmenter/session/session_map.hpp"
#include "tests/segmenter/process/slice_session.hpp"

namespace kintsugi::segmenter {
namespace {

using std::chrono::seconds;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::LabelMirror;
using testing::wavy_session;

class SessionMapTest : public ::testing::Test {
 protected:
  SessionMap make(const std::string& mode, bool coalesce = false) {
    SessionMap::Config config;
    config.coalesce = coalesce;
    return make(config, mode);
  }

  SessionMap make(const SessionMap::Config& config, const std::string& mode = "exact") {
    SegmentMapConfig map_config;
    map_config.mode = mode;
    return {config, std::make_unique<SegmentMap>(map_config, 99, wavy_session(1, 1)[0])};
  }

  /// Keeps the result of a step; returns whether there was one to do.
  bool step(SessionMap& map, Outlook outlook = Outlook::kSilent) {
    StepResult result = map.step(now_, outlook);
    std::ranges::move(result.updates, std::back_inserter(updates_));
    std::ranges::move(result.warnings, std::back_inserter(warnings_));
    for (const SaveRequest& request : result.saves) saves_.push_back(saved(request));
    return result.has_progressed;
  }
  void run(SessionMap& map, Outlook outlook = Outlook::kSilent) {
    while (step(map, outlook)) {
    }
  }
  void save(SessionMap& map, bool again = false) {
    if (const auto request = map.save(again)) saves_.push_back(saved(*request));
  }

  struct Saved {
    std::int64_t session;
    PointIndex num_points;
    SaveKind kind;
  };
  static Saved saved(const SaveRequest& request) {
    return {request.map->map_session(), request.map->cloud().num_live(), request.kind};
  }

  SessionMap::Clock::time_point now_{seconds(1000)};
  std::vector<SegmentUpdate> updates_;
  std::vector<Saved> saves_;
  std::vector<std::string> warnings_;
};

TEST_F(SessionMapTest, PublishesUpdatesThatReplayToTheMap) {
  for (const std::string mode : {"batch", "voting"}) {
    updates_.clear();
    SessionMap map = make(mode);
    LabelMirror mirror;
    std::size_t num_mirrored = 0;
    for (const CloudSlice& slice : wavy_session(6, 300)) {
      map.offer(slice, now_);
      run(map);
      for (; num_mirrored < updates_.size(); ++num_mirrored) {
        mirror.apply(updates_[num_mirrored]);
      }
      EXPECT_EQ(mirror.labels(), testing::labels_of(map.segment_map())) << mode << slice.id;
      EXPECT_EQ(mirror.num_segments(), updates_.back().num_segments) << mode << slice.id;
    }
    ASSERT_EQ(updates_.size(), 6U);
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_EQ(updates_[i].slice_id, static_cast<int>(i));
      EXPECT_EQ(updates_[i].session, 99);
      EXPECT_EQ(updates_[i].map_session, 5);
      EXPECT_EQ(updates_[i].is_final, i == 5);
    }
    EXPECT_EQ(mirror.statistics(), map.segment_map().statistics().all());
    EXPECT_TRUE(map.counts().complete);
    EXPECT_EQ(map.counts().lag, 0);
  }
}

TEST_F(SessionMapTest, MapDoesNotDependOnTheOrderOfArrival) {
  std::mt19937 random(11);
  for (const std::string mode : {"batch", "voting"}) {
    std::vector<CloudSlice> slices = wavy_session(6, 200);
    SessionMap in_order = make(mode);
    for (const CloudSlice& slice : slices) {
      in_order.offer(slice, now_);
    }
    run(in_order);
    for (int round = 0; round < 5; ++round) {
      std::shuffle(slices.begin(), slices.end(), random);
      SessionMap shuffled = make(mode);
      for (const CloudSlice& slice : slices) {
        shuffled.offer(slice, now_);
        shuffled.offer(slice, now_);  // a duplicate changes nothing
        run(shuffled);
      }
      EXPECT_EQ(testing::labels_of(shuffled.segment_map()),
                testing::labels_of(in_order.segment_map()));
      EXPECT_EQ(shuffled.segment_map().statistics().all(),
                in_order.segment_map().statistics().all());
    }
  }
  EXPECT_THAT(warnings_, ::testing::IsEmpty());
}

TEST_F(SessionMapTest, CoalescingSegmentsWaitingSlicesInOneRunWithOneUpdateEach) {
  const auto slices = wavy_session(5, 200);
  SessionMap one_run = make("batch", true);
  for (const CloudSlice& slice : slices) {
    one_run.offer(slice, now_);
  }
  EXPECT_EQ(one_run.counts().lag, 5);
  EXPECT_TRUE(step(one_run));
  EXPECT_FALSE(step(one_run));
  ASSERT_EQ(updates_.size(), 5U);
  LabelMirror mirror;
  for (const SegmentUpdate& update : updates_) {
    mirror.apply(update);
    EXPECT_EQ(update.is_final, update.slice_id == 4);
    EXPECT_EQ(update.num_slices, update.slice_id + 1);
    EXPECT_EQ(update.num_points, 200 * (update.slice_id + 1));
  }
  EXPECT_EQ(mirror.labels(), testing::labels_of(one_run.segment_map()));

  SessionMap each = make("batch");
  for (const CloudSlice& slice : slices) {
    each.offer(slice, now_);
    run(each);
  }
  EXPECT_TRUE(testing::same_partition(testing::labels_of(one_run.segment_map()),
                                      testing::labels_of(each.segment_map())));
}

TEST_F(SessionMapTest, GoesOnWithoutAMissingSliceAfterTheTimeout) {
  const auto slices = wavy_session(4, 100);
  SessionMap map = make("batch");
  for (const int i : {0, 2, 3}) {
    map.offer(slices[i], now_);
  }
  run(map);
  EXPECT_EQ(map.counts().segmented, 1);
  EXPECT_EQ(map.counts().lag, 3);  // one of them is only known to exist
  now_ += seconds(11);
  run(map);
  EXPECT_EQ(map.counts().segmented, 3);
  EXPECT_EQ(map.counts().missing, 1);
  EXPECT_FALSE(map.counts().complete);
  EXPECT_TRUE(map.counts().ended);
  EXPECT_FALSE(updates_.back().is_final);
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr("slices 1 to 1 of session 5 are missing")));

  map.offer(slices[1], now_);  // it comes after all
  run(map);
  EXPECT_TRUE(map.counts().complete);
  EXPECT_TRUE(updates_.back().is_final);
  EXPECT_EQ(map.counts().missing, 0);
}

TEST_F(SessionMapTest, RefusesOtherResolutionsAndOtherMapsAndSaysWhy) {
  auto slices = wavy_session(3, 50);
  SessionMap map = make("batch");
  EXPECT_EQ(map.offer(slices[0], now_), std::nullopt);
  slices[1].resolution_m = 0.02F;
  EXPECT_THAT(*map.offer(slices[1], now_), HasSubstr("resolution"));
  slices[2].map_name = "kitchen";
  EXPECT_THAT(*map.offer(slices[2], now_), HasSubstr("'kitchen'"));
  EXPECT_EQ(map.counts().received, 1);
}

TEST_F(SessionMapTest, WaitsForAMissingSliceAsLongAsItIsBeingSentAgain) {
  const auto slices = wavy_session(3, 100);
  SessionMap map = make("batch");
  map.offer(slices[0], now_);
  map.offer(slices[2], now_);
  now_ += seconds(1000);
  EXPECT_TRUE(step(map, Outlook::kLive));
  EXPECT_FALSE(step(map, Outlook::kLive));
  EXPECT_EQ(map.counts().missing, 0);
  EXPECT_EQ(map.waiting_bytes(), bytes_of(slices[2]));
  map.offer(slices[1], now_);
  run(map);
  EXPECT_TRUE(map.counts().complete);
  EXPECT_EQ(map.waiting_bytes(), 0U);
}

TEST_F(SessionMapTest, CoalescingTakesTheNewestRevisionOfEachSlice) {
  auto slices = wavy_session(3, 100);
  SessionMap map = make("batch", true);
  map.offer(slices[0], now_);
  run(map);
  for (const int i : {1, 0, 1, 2}) {
    map.offer(slices[i], now_);
    slices[i].points_W.pop_back();
    ++slices[i].revision;
    map.offer(slices[i], now_);
  }
  run(map, Outlook::kEnded);
  ASSERT_EQ(updates_.size(), 4U);
  EXPECT_EQ(map.segment_map().cloud().find_slice(1)->revision, 2);
  EXPECT_EQ(map.counts().points, 99 + 98 + 99);
  EXPECT_EQ(map.counts().segmented, 3);
  EXPECT_EQ(map.counts().corrected, 1);
}

TEST_F(SessionMapTest, SavesWhatCanBeSavedWhenSegmentingFails) {
  SessionMap map = make("batch");
  auto slices = wavy_session(2, 50);
  map.offer(slices[0], now_);
  run(map);
  slices[1].id = -1;  // refused by the map, and by the codec before it
  map.offer(slices[1], now_);
  EXPECT_THROW(run(map), std::invalid_argument);
  save(map);
  EXPECT_EQ(saves_.back().kind, SaveKind::kBroken);
}

TEST_F(SessionMapTest, LabelsRejectedPointsZeroAndCountsThem) {
  auto slices = wavy_session(1, 50);
  slices[0].points_W[7].x = std::numeric_limits<float>::quiet_NaN();
  slices[0].points_W[9].nz = 0.0F;
  slices[0].points_W[9].nx = 0.0F;
  slices[0].points_W[9].ny = 0.0F;
  SessionMap map = make("batch");
  map.offer(slices[0], now_);
  run(map);
  EXPECT_EQ(map.counts().rejected, 2);
  EXPECT_EQ(map.counts().points, 48);
  EXPECT_EQ(updates_[0].labels.size(), 50U);
  EXPECT_EQ(std::ranges::count(updates_[0].labels, kNoSegment), 2);
  EXPECT_EQ(updates_[0].labels[7], kNoSegment);
}

TEST_F(SessionMapTest, AcceptsEmptySlices) {
  auto slices = wavy_session(3, 40);
  slices[0].points_W.clear();
  slices[2].points_W.clear();
  for (const std::string mode : {"batch", "voting"}) {
    updates_.clear();
    SessionMap map = make(mode);
    for (const CloudSlice& slice : slices) {
      map.offer(slice, now_);
    }
    run(map);
    EXPECT_EQ(updates_.size(), 3U);
    EXPECT_TRUE(updates_.back().is_final);
  }
}

TEST_F(SessionMapTest, SavesWhenAskedAndWhenDue) {
  SessionMap::Config config;
  config.write_every = 2;
  SessionMap map = make(config);
  save(map);  // there is nothing yet
  const auto slices = wavy_session(6, 50);
  for (int i = 0; i < 5; ++i) {
    map.offer(slices[i], now_);
    run(map);
  }
  EXPECT_EQ(saves_.size(), 2U);
  save(map);
  save(map);  // nothing new
  EXPECT_EQ(saves_.size(), 3U);
  EXPECT_EQ(saves_.back().num_points, 250U);
}

// Its files may be older, as after a kill, or of another name.
TEST_F(SessionMapTest, SavesAMapThatWasResumedAlsoWithoutNewSlices) {
  const auto slices = wavy_session(3, 50);
  auto resumed = std::make_unique<SegmentMap>(SegmentMapConfig(), 99, slices[0]);
  (void)resumed->add(slices);
  SessionMap map(SessionMap::Config(), std::move(resumed));
  save(map);
  save(map);  // nothing new
  ASSERT_EQ(saves_.size(), 1U);
  EXPECT_EQ(saves_.back().num_points, 150U);
}

TEST_F(SessionMapTest, SavesAgainWhenTold) {
  SessionMap map = make("batch");
  map.offer(wavy_session(1, 50)[0], now_);
  run(map);
  EXPECT_EQ(saves_.size(), 1U);  // it is complete
  save(map);
  EXPECT_EQ(saves_.size(), 1U);
  save(map, true);
  EXPECT_EQ(saves_.size(), 2U);
}

TEST_F(SessionMapTest, SavesForResumeMoreOftenThanItWritesTheMapFiles) {
  SessionMap::Config config;
  config.write_every = 4;
  config.save_every = 2;
  SessionMap map = make(config);
  const auto slices = wavy_session(9, 50);
  for (int i = 0; i < 8; ++i) {
    map.offer(slices[i], now_);
    run(map);
  }
  std::vector<SaveKind> kinds;
  for (const Saved& save : saves_) {
    kinds.push_back(save.kind);
  }
  EXPECT_THAT(kinds, ElementsAre(SaveKind::kForResume, SaveKind::kCurrent, SaveKind::kForResume,
                                 SaveKind::kCurrent));
}

TEST_F(SessionMapTest, RefusesABadConfig) {
  SessionMap::Config config;
  config.write_every = -1;
  EXPECT_THROW(make(config), std::invalid_argument);
  config = {};
  config.save_every = -1;
  EXPECT_THROW(make(config), std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi::segmenter
