// Slices that come again: a third of a map is moved in one go, and back.

#include <algorithm>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "segmenter/core/make_engine.hpp"
#include "segmenter/session/session_map.hpp"
#include "tests/segmenter/process/room_session.hpp"
#include "tests/segmenter/process/slice_session.hpp"

namespace kintsugi::segmenter {
namespace {

using std::chrono::seconds;
using testing::LabelMirror;
using testing::Labels;

// Modes whose partition is a function of the points alone.
std::vector<std::string> modes_equal_to_batch() {
  std::vector<std::string> modes;
  for (const std::string_view mode : engine_modes()) {
    if (mode != "voting") modes.emplace_back(mode);
  }
  return modes;
}

Labels batch_labels(const std::vector<CloudSlice>& slices) {
  SegmentMapConfig config;
  config.mode = "batch";
  SegmentMap map(config, 1, slices[0]);
  map.add(slices);
  return testing::labels_of(map);
}

class Revisions : public ::testing::Test {
 protected:
  Revisions() {
    Eigen::Isometry3d X_WW = testing::small_motion();
    for (std::size_t i = slices_.size() / 3; i < 2 * slices_.size() / 3; ++i) {
      moved_[i] = testing::moved(slices_[i], X_WW);
      back_[i] = slices_[i];
      back_[i].revision = 2;
    }
  }

  SessionMap make(const std::string& mode) {
    SegmentMapConfig config;
    config.mode = mode;
    return make(std::make_unique<SegmentMap>(config, 99, slices_[0]));
  }

  SessionMap make(std::unique_ptr<SegmentMap> map) { return {{}, std::move(map)}; }

  /// Applies the updates of a step; returns whether there was one to do.
  bool step(SessionMap& map) {
    const StepResult result = map.step(now_, Outlook::kSilent);
    for (const SegmentUpdate& update : result.updates) {
      mirror_.apply(update);
      ++num_updates_;
    }
    EXPECT_TRUE(result.warnings.empty()) << result.warnings.front();
    return result.has_progressed;
  }

  /// As a process that resumes a map: it first sends the full state.
  SessionMap resume(std::unique_ptr<SegmentMap> map) {
    for (const SegmentUpdate& update : map->describe()) {
      mirror_.apply(update);
      ++num_updates_;
    }
    return make(std::move(map));
  }

  /// Offers the slices that are new and segments them.
  void run(SessionMap& session, const std::vector<CloudSlice>& slices) {
    for (const CloudSlice& slice : slices) {
      session.offer(slice, now_);
    }
    now_ += seconds(1);  // more than a pause in corrections
    while (step(session)) {
    }
    EXPECT_EQ(session.counts().lag, 0);
    EXPECT_TRUE(session.counts().complete);
    EXPECT_EQ(mirror_.labels(), testing::labels_of(session.segment_map()));
    EXPECT_EQ(mirror_.statistics(), session.segment_map().statistics().all());
    EXPECT_EQ(mirror_.num_segments(), session.counts().segments);
  }

  std::vector<CloudSlice> every_revision_twice() const {
    std::vector<CloudSlice> all;
    for (const auto* slices : {&slices_, &moved_, &back_, &slices_, &moved_, &back_}) {
      all.insert(all.end(), slices->begin(), slices->end());
    }
    return all;
  }

  const std::vector<CloudSlice> slices_ = testing::RoomRow(2, 0.05).cut(0.4);
  std::vector<CloudSlice> moved_ = slices_;
  std::vector<CloudSlice> back_ = slices_;
  SessionMap::Clock::time_point now_{seconds(1000)};
  LabelMirror mirror_;
  int num_updates_ = 0;
};

TEST_F(Revisions, MovingAThirdOfTheMapAndBackGivesWhatBatchGivesEachTime) {
  for (const std::string& mode : modes_equal_to_batch()) {
    mirror_ = {};
    SessionMap session = make(mode);
    run(session, slices_);
    const Labels original = testing::labels_of(session.segment_map());
    EXPECT_GT(session.counts().segments, 100);
    EXPECT_TRUE(testing::same_partition(original, batch_labels(slices_))) << mode;

    num_updates_ = 0;
    run(session, moved_);  // those that did not move are duplicates
    const auto num_moved = std::ssize(slices_) * 2 / 3 - std::ssize(slices_) / 3;
    EXPECT_EQ(num_updates_, num_moved);
    EXPECT_EQ(session.counts().corrected, num_moved);
    const Labels after = testing::labels_of(session.segment_map());
    EXPECT_TRUE(testing::same_partition(after, batch_labels(moved_))) << mode;
    EXPECT_FALSE(testing::same_partition(after, original)) << "the motion changes nothing";

    run(session, back_);
    EXPECT_TRUE(testing::same_partition(testing::labels_of(session.segment_map()), original))
        << mode;
    EXPECT_EQ(session.segment_map().cloud().num_live(), session.counts().points);
    EXPECT_EQ(session.counts().received, std::ssize(slices_));
  }
}

TEST_F(Revisions, UpdatesReplayToTheMapInEveryMode) {
  for (const std::string_view mode : engine_modes()) {
    mirror_ = {};
    SessionMap session = make(std::string(mode));
    run(session, slices_);
    run(session, moved_);
    run(session, back_);
  }
}

TEST_F(Revisions, CorrectionsOfOneGoAreOneRun) {
  SessionMap session = make("batch");
  run(session, slices_);
  for (const CloudSlice& slice : moved_) {
    session.offer(slice, now_);
    EXPECT_FALSE(step(session));
  }
  now_ += seconds(1);
  EXPECT_TRUE(step(session));
  EXPECT_FALSE(step(session));
}

TEST_F(Revisions, FinalMapIsTheSameInAnyOrderOfArrivalWithDuplicates) {
  std::vector<CloudSlice> all = every_revision_twice();
  std::mt19937 random(17);
  for (const std::string& mode : modes_equal_to_batch()) {
    SessionMap in_order = make(mode);
    mirror_ = {};
    run(in_order, back_);
    const Labels expected = testing::labels_of(in_order.segment_map());
    for (int round = 0; round < 2; ++round) {
      std::ranges::shuffle(all, random);
      SessionMap shuffled = make(mode);
      mirror_ = {};
      for (const CloudSlice& slice : all) {
        shuffled.offer(slice, now_);
        if (random() % 4 == 0) {
          while (step(shuffled)) {
          }
        }
      }
      run(shuffled, {});
      EXPECT_TRUE(testing::same_partition(testing::labels_of(shuffled.segment_map()), expected))
          << mode;
      for (const SliceRecord& slice : shuffled.segment_map().cloud().slices()) {
        EXPECT_EQ(slice.revision, back_[static_cast<std::size_t>(slice.slice_id)].revision);
      }
    }
  }
}

TEST_F(Revisions, FinalMapIsTheSameWhenASegmenterStopsAnywhereAndAnotherHearsEverything) {
  std::vector<CloudSlice> all = every_revision_twice();
  const Labels expected = batch_labels(back_);
  std::mt19937 random(18);
  for (const std::string& mode : modes_equal_to_batch()) {
    for (int round = 0; round < 2; ++round) {
      std::ranges::shuffle(all, random);
      SessionMap first = make(mode);
      const std::size_t num_heard = 1 + random() % all.size();
      for (std::size_t i = 0; i < num_heard; ++i) {
        first.offer(all[i], now_);
        while (step(first)) {
        }
      }
      mirror_ = {};
      SessionMap second = resume(std::make_unique<SegmentMap>(first.segment_map().state()));
      std::ranges::shuffle(all, random);
      run(second, all);
      EXPECT_TRUE(testing::same_partition(mirror_.labels(), expected)) << mode;
    }
  }
}

TEST_F(Revisions, IdsDependOnTheOrderOfArrivalAndNotOnTiming) {
  std::vector<CloudSlice> all = slices_;
  std::ranges::copy_if(moved_, std::inserter(all, all.begin() + std::ssize(slices_) * 3 / 4),
                       [](const CloudSlice& slice) { return slice.revision > 0; });
  SessionMap late = make("batch");
  run(late, all);
  SessionMap at_once = make("batch");
  mirror_ = {};
  for (const CloudSlice& slice : all) {
    at_once.offer(slice, now_);
    while (step(at_once)) {
    }
  }
  run(at_once, {});
  EXPECT_EQ(testing::labels_of(late.segment_map()), testing::labels_of(at_once.segment_map()));
}

TEST_F(Revisions, ANewSegmenterGoesOnWithTheMapOfAnEarlierOne) {
  for (const std::string& mode : modes_equal_to_batch()) {
    for (const std::size_t num_done : {std::size_t{1}, slices_.size() / 2, slices_.size()}) {
      SegmentMapConfig config;
      config.mode = mode;
      auto map = std::make_unique<SegmentMap>(config, 99, slices_[0]);
      for (std::size_t i = 0; i < num_done; ++i) {
        map->add({&slices_[i], 1});
      }
      mirror_ = {};
      num_updates_ = 0;
      SessionMap session = resume(std::move(map));
      EXPECT_EQ(num_updates_, static_cast<int>(num_done));
      EXPECT_EQ(mirror_.labels(), testing::labels_of(session.segment_map()));
      EXPECT_EQ(session.counts().segmented, static_cast<std::int64_t>(num_done));
      run(session, slices_);
      EXPECT_TRUE(testing::same_partition(mirror_.labels(), batch_labels(slices_)));
      run(session, moved_);
      EXPECT_TRUE(testing::same_partition(mirror_.labels(), batch_labels(moved_)));
    }
  }
}

}  // namespace
}  // namespace kintsugi::segmenter
