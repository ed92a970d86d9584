// The process without threads and bus: slices in, updates and maps out.

#include <algorithm>
#include <map>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "segmenter/process/slice_processor.hpp"
#include "tests/segmenter/process/slice_session.hpp"

namespace kintsugi::segmenter {
namespace {

using std::chrono::seconds;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::LabelMirror;
using testing::wavy_session;

class SliceProcessorTest : public ::testing::Test {
 protected:
  SliceProcessor make(const std::string& mode, bool coalesce = false) {
    SliceProcessor::Config config;
    config.coalesce = coalesce;
    return make(config, mode);
  }

  SliceProcessor make(const SliceProcessor::Config& config, const std::string& mode = "exact") {
    SegmentMapConfig map_config;
    map_config.mode = mode;
    return {config,
            std::make_unique<SegmentMap>(map_config, 99, wavy_session(1, 1)[0]),
            {[this](SegmentUpdate update) { updates_.push_back(std::move(update)); },
             [this](const SegmentMap& map, SliceProcessor::Save why) {
               saves_.push_back({map.map_session(), map.cloud().num_live(), why});
             },
             [this](const std::string& text) { warnings_.push_back(text); }}};
  }

  void run(SliceProcessor& processor) {
    while (processor.step(now_, Outlook::kSilent)) {
    }
  }

  struct Saved {
    std::int64_t session;
    PointIndex num_points;
    SliceProcessor::Save why;
  };

  SliceProcessor::Clock::time_point now_{seconds(1000)};
  std::vector<SegmentUpdate> updates_;
  std::vector<Saved> saves_;
  std::vector<std::string> warnings_;
};

TEST_F(SliceProcessorTest, PublishesUpdatesThatReplayToTheMap) {
  for (const std::string mode : {"batch", "voting"}) {
    updates_.clear();
    SliceProcessor processor = make(mode);
    LabelMirror mirror;
    std::size_t num_mirrored = 0;
    for (const CloudSlice& slice : wavy_session(6, 300)) {
      processor.offer(slice, now_);
      run(processor);
      for (; num_mirrored < updates_.size(); ++num_mirrored) {
        mirror.apply(updates_[num_mirrored]);
      }
      EXPECT_EQ(mirror.labels(), testing::labels_of(processor.map())) << mode << slice.id;
      EXPECT_EQ(mirror.num_segments(), updates_.back().num_segments) << mode << slice.id;
    }
    ASSERT_EQ(updates_.size(), 6U);
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_EQ(updates_[i].slice_id, static_cast<int>(i));
      EXPECT_EQ(updates_[i].session, 99);
      EXPECT_EQ(updates_[i].map_session, 5);
      EXPECT_EQ(updates_[i].is_final, i == 5);
    }
    EXPECT_EQ(mirror.statistics(), processor.map().statistics().all());
    EXPECT_TRUE(processor.counts().complete);
    EXPECT_EQ(processor.counts().lag, 0);
  }
}

TEST_F(SliceProcessorTest, MapDoesNotDependOnTheOrderOfArrival) {
  std::mt19937 random(11);
  for (const std::string mode : {"batch", "voting"}) {
    std::vector<CloudSlice> slices = wavy_session(6, 200);
    SliceProcessor in_order = make(mode);
    for (const CloudSlice& slice : slices) {
      in_order.offer(slice, now_);
    }
    run(in_order);
    for (int round = 0; round < 5; ++round) {
      std::shuffle(slices.begin(), slices.end(), random);
      SliceProcessor shuffled = make(mode);
      for (const CloudSlice& slice : slices) {
        shuffled.offer(slice, now_);
        shuffled.offer(slice, now_);  // a duplicate changes nothing
        run(shuffled);
      }
      EXPECT_EQ(testing::labels_of(shuffled.map()), testing::labels_of(in_order.map()));
      EXPECT_EQ(shuffled.map().statistics().all(), in_order.map().statistics().all());
    }
  }
  EXPECT_THAT(warnings_, ::testing::IsEmpty());
}

TEST_F(SliceProcessorTest, CoalescingSegmentsWaitingSlicesInOneRunWithOneUpdateEach) {
  const auto slices = wavy_session(5, 200);
  SliceProcessor one_run = make("batch", true);
  for (const CloudSlice& slice : slices) {
    one_run.offer(slice, now_);
  }
  EXPECT_EQ(one_run.counts().lag, 5);
  EXPECT_TRUE(one_run.step(now_, Outlook::kSilent));
  EXPECT_FALSE(one_run.step(now_, Outlook::kSilent));
  ASSERT_EQ(updates_.size(), 5U);
  LabelMirror mirror;
  for (const SegmentUpdate& update : updates_) {
    mirror.apply(update);
    EXPECT_EQ(update.is_final, update.slice_id == 4);
    EXPECT_EQ(update.num_slices, update.slice_id + 1);
    EXPECT_EQ(update.num_points, 200 * (update.slice_id + 1));
  }
  EXPECT_EQ(mirror.labels(), testing::labels_of(one_run.map()));

  SliceProcessor each = make("batch");
  for (const CloudSlice& slice : slices) {
    each.offer(slice, now_);
    run(each);
  }
  EXPECT_TRUE(
      testing::same_partition(testing::labels_of(one_run.map()), testing::labels_of(each.map())));
}

TEST_F(SliceProcessorTest, GoesOnWithoutAMissingSliceAfterTheTimeout) {
  const auto slices = wavy_session(4, 100);
  SliceProcessor processor = make("batch");
  for (const int i : {0, 2, 3}) {
    processor.offer(slices[i], now_);
  }
  run(processor);
  EXPECT_EQ(processor.counts().segmented, 1);
  EXPECT_EQ(processor.counts().lag, 3);  // one of them is only known to exist
  now_ += seconds(11);
  run(processor);
  EXPECT_EQ(processor.counts().segmented, 3);
  EXPECT_EQ(processor.counts().missing, 1);
  EXPECT_FALSE(processor.counts().complete);
  EXPECT_TRUE(processor.counts().ended);
  EXPECT_FALSE(updates_.back().is_final);
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr("slices 1 to 1 of session 5 are missing")));

  processor.offer(slices[1], now_);  // it comes after all
  run(processor);
  EXPECT_TRUE(processor.counts().complete);
  EXPECT_TRUE(updates_.back().is_final);
  EXPECT_EQ(processor.counts().missing, 0);
}

TEST_F(SliceProcessorTest, RefusesOtherResolutionsAndOtherMapsAndSaysWhy) {
  auto slices = wavy_session(3, 50);
  SliceProcessor processor = make("batch");
  EXPECT_EQ(processor.offer(slices[0], now_), std::nullopt);
  slices[1].resolution_m = 0.02F;
  EXPECT_THAT(*processor.offer(slices[1], now_), HasSubstr("resolution"));
  slices[2].map_name = "kitchen";
  EXPECT_THAT(*processor.offer(slices[2], now_), HasSubstr("'kitchen'"));
  EXPECT_EQ(processor.counts().received, 1);
}

TEST_F(SliceProcessorTest, WaitsForAMissingSliceAsLongAsItIsBeingSentAgain) {
  const auto slices = wavy_session(3, 100);
  SliceProcessor processor = make("batch");
  processor.offer(slices[0], now_);
  processor.offer(slices[2], now_);
  now_ += seconds(1000);
  EXPECT_TRUE(processor.step(now_, Outlook::kLive));
  EXPECT_FALSE(processor.step(now_, Outlook::kLive));
  EXPECT_EQ(processor.counts().missing, 0);
  EXPECT_EQ(processor.waiting_bytes(), bytes_of(slices[2]));
  processor.offer(slices[1], now_);
  run(processor);
  EXPECT_TRUE(processor.counts().complete);
  EXPECT_EQ(processor.waiting_bytes(), 0U);
}

TEST_F(SliceProcessorTest, CoalescingTakesTheNewestRevisionOfEachSlice) {
  auto slices = wavy_session(3, 100);
  SliceProcessor processor = make("batch", true);
  processor.offer(slices[0], now_);
  run(processor);
  for (const int i : {1, 0, 1, 2}) {
    processor.offer(slices[i], now_);
    slices[i].points_W.pop_back();
    ++slices[i].revision;
    processor.offer(slices[i], now_);
  }
  processor.finish(now_);
  ASSERT_EQ(updates_.size(), 4U);
  EXPECT_EQ(processor.map().cloud().find_slice(1)->revision, 2);
  EXPECT_EQ(processor.counts().points, 99 + 98 + 99);
  EXPECT_EQ(processor.counts().segmented, 3);
  EXPECT_EQ(processor.counts().corrected, 1);
}

TEST_F(SliceProcessorTest, SavesWhatCanBeSavedWhenSegmentingFails) {
  SliceProcessor processor = make("batch");
  auto slices = wavy_session(2, 50);
  processor.offer(slices[0], now_);
  run(processor);
  slices[1].id = -1;  // refused by the map, and by the codec before it
  processor.offer(slices[1], now_);
  EXPECT_THROW(run(processor), std::invalid_argument);
  processor.save();
  EXPECT_EQ(saves_.back().why, SliceProcessor::Save::kBroken);
}

TEST_F(SliceProcessorTest, LabelsRejectedPointsZeroAndCountsThem) {
  auto slices = wavy_session(1, 50);
  slices[0].points_W[7].x = std::numeric_limits<float>::quiet_NaN();
  slices[0].points_W[9].nz = 0.0F;
  slices[0].points_W[9].nx = 0.0F;
  slices[0].points_W[9].ny = 0.0F;
  SliceProcessor processor = make("batch");
  processor.offer(slices[0], now_);
  run(processor);
  EXPECT_EQ(processor.counts().rejected, 2);
  EXPECT_EQ(processor.counts().points, 48);
  EXPECT_EQ(updates_[0].labels.size(), 50U);
  EXPECT_EQ(std::ranges::count(updates_[0].labels, kNoSegment), 2);
  EXPECT_EQ(updates_[0].labels[7], kNoSegment);
}

TEST_F(SliceProcessorTest, AcceptsEmptySlices) {
  auto slices = wavy_session(3, 40);
  slices[0].points_W.clear();
  slices[2].points_W.clear();
  for (const std::string mode : {"batch", "voting"}) {
    updates_.clear();
    SliceProcessor processor = make(mode);
    for (const CloudSlice& slice : slices) {
      processor.offer(slice, now_);
    }
    run(processor);
    EXPECT_EQ(updates_.size(), 3U);
    EXPECT_TRUE(updates_.back().is_final);
  }
}

TEST_F(SliceProcessorTest, SavesWhenAskedAndWhenDue) {
  SliceProcessor::Config config;
  config.write_every = 2;
  SliceProcessor processor = make(config);
  processor.save();  // there is nothing yet
  const auto slices = wavy_session(6, 50);
  for (int i = 0; i < 5; ++i) {
    processor.offer(slices[i], now_);
    run(processor);
  }
  EXPECT_EQ(saves_.size(), 2U);
  processor.save();
  processor.save();  // nothing new
  EXPECT_EQ(saves_.size(), 3U);
  EXPECT_EQ(saves_.back().num_points, 250U);
}

TEST_F(SliceProcessorTest, SavesAgainWhenTold) {
  SliceProcessor processor = make("batch");
  processor.offer(wavy_session(1, 50)[0], now_);
  run(processor);
  EXPECT_EQ(saves_.size(), 1U);  // it is complete
  processor.save();
  EXPECT_EQ(saves_.size(), 1U);
  processor.save(true);
  EXPECT_EQ(saves_.size(), 2U);
}

TEST_F(SliceProcessorTest, SavesToGoOnMoreOftenThanToLookAt) {
  SliceProcessor::Config config;
  config.write_every = 4;
  config.save_every = 2;
  SliceProcessor processor = make(config);
  const auto slices = wavy_session(9, 50);
  for (int i = 0; i < 8; ++i) {
    processor.offer(slices[i], now_);
    run(processor);
  }
  std::vector<SliceProcessor::Save> why;
  for (const Saved& save : saves_) {
    why.push_back(save.why);
  }
  using Save = SliceProcessor::Save;
  EXPECT_THAT(why, ElementsAre(Save::kToGoOn, Save::kCurrent, Save::kToGoOn, Save::kCurrent));
}

TEST_F(SliceProcessorTest, RefusesABadConfig) {
  SliceProcessor::Config config;
  config.write_every = -1;
  EXPECT_THROW(make(config), std::invalid_argument);
  config = {};
  config.save_every = -1;
  EXPECT_THROW(make(config), std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi::segmenter
