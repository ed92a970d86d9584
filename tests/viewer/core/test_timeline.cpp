// The history of one segment: from updates in any order to a picture.

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "viewer/core/charts/segment_timeline.hpp"
#include "viewer/core/charts/tag_rows.hpp"
#include "viewer/core/charts/timeline_chart.hpp"
#include "viewer/core/drawing/palette.hpp"

namespace kintsugi::viewer {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using enum SegmentTimeline::EventType;
using Event = SegmentTimeline::Event;
using Size = SegmentTimeline::Size;

constexpr std::int64_t kSession = 2'000;

SegmentUpdate update_after(std::int32_t num_slices, std::vector<SegmentEvent> events,
                           const std::vector<UpdateLog::Size>& sizes) {
  SegmentUpdate update;
  update.session = kSession;
  update.sequence = num_slices;
  update.num_slices = num_slices;
  update.events = std::move(events);
  for (const auto& [id, num_points] : sizes) {
    update.statistics.push_back({.segment_id = id, .num_points = num_points});
  }
  return update;
}

/// Segment 2 begins with slice 2, grows, absorbs 3 (20 points), loses 4, and ends in 1.
std::vector<SegmentUpdate> life_of_two() {
  using enum SegmentEventType;
  return {update_after(1, {{kCreated, 1}}, {{1, 100}}),
          update_after(2, {{kCreated, 2}, {kCreated, 3}}, {{2, 10}, {3, 20}}),
          update_after(3, {{kGrown, 2}}, {{2, 15}}),
          update_after(4, {{kMerged, 2, 3}}, {{2, 35}}),
          update_after(5, {{kSplit, 2, 4}}, {{2, 30}, {4, 5}}),
          update_after(6, {{kMerged, 1, 2}}, {{1, 130}}),
          update_after(7, {{kGrown, 1}}, {{1, 140}})};
}

SegmentTimeline timeline_of(std::uint32_t id, const std::vector<SegmentUpdate>& updates) {
  UpdateLog log;
  for (const SegmentUpdate& update : updates) log.add(update);
  return viewer::timeline_of(id, log);
}

TEST(Timeline, IsEmptyForPointsInNoSegment) {
  const SegmentTimeline timeline = timeline_of(kNoSegment, life_of_two());
  EXPECT_THAT(timeline.events, IsEmpty());
  EXPECT_FALSE(timeline.is_known());
}

TEST(Timeline, TellsALifeFromBeginningToEnd) {
  const SegmentTimeline timeline = timeline_of(2, life_of_two());
  EXPECT_THAT(timeline.events, ElementsAre(Event{2, kCreated}, Event{4, kAbsorbed, 3, 20},
                                           Event{5, kSplit, 4, 5}, Event{6, kMergedInto, 1, 130}));
  EXPECT_THAT(timeline.sizes,
              ElementsAre(Size{2, 10}, Size{3, 15}, Size{4, 35}, Size{5, 30}, Size{6, 0}));
  EXPECT_EQ(7, timeline.num_slices);
  EXPECT_TRUE(timeline.has_beginning());
}

TEST(Timeline, TellsWhatWasSplitOffAndWhatRetired) {
  std::vector<SegmentUpdate> updates = life_of_two();
  updates.push_back(update_after(8, {{SegmentEventType::kRetired, 4}}, {}));
  const SegmentTimeline timeline = timeline_of(4, updates);
  EXPECT_THAT(timeline.events, ElementsAre(Event{5, kSplitOff, 2, 30}, Event{8, kRetired}));
  EXPECT_THAT(timeline.sizes, ElementsAre(Size{5, 5}, Size{8, 0}));
}

TEST(Timeline, IsTheSameInWhateverOrderAndHoweverOftenUpdatesCome) {
  std::vector<SegmentUpdate> updates = life_of_two();
  const SegmentTimeline expected = timeline_of(2, updates);
  updates.insert(updates.end(), updates.begin(), updates.begin() + 4);
  std::mt19937 random(3);
  for (int trial = 0; trial < 20; ++trial) {
    std::ranges::shuffle(updates, random);
    const SegmentTimeline timeline = timeline_of(2, updates);
    EXPECT_EQ(expected.events, timeline.events);
    EXPECT_EQ(expected.sizes, timeline.sizes);
  }
}

TEST(Timeline, BeginsForALateListenerWithTheStateItGot) {
  std::vector<SegmentUpdate> updates = life_of_two();
  updates.erase(updates.begin(), updates.begin() + 4);
  updates.push_back(update_after(4, {}, {{1, 100}, {2, 35}}));
  const SegmentTimeline timeline = timeline_of(2, updates);
  EXPECT_FALSE(timeline.has_beginning());
  EXPECT_THAT(timeline.sizes, ElementsAre(Size{4, 35}, Size{5, 30}, Size{6, 0}));
}

TEST(Timeline, IsNotChangedByAStateThatSomebodyElseAskedFor) {
  std::vector<SegmentUpdate> updates = life_of_two();
  SegmentUpdate state = update_after(3, {}, {{1, 100}, {2, 15}, {3, 20}});
  for (std::size_t i = 3; i < updates.size(); ++i) ++updates[i].sequence;
  state.sequence = 4;
  const SegmentTimeline expected = timeline_of(2, updates);
  updates.push_back(state);
  const SegmentTimeline timeline = timeline_of(2, updates);
  EXPECT_EQ(expected.events, timeline.events);
  EXPECT_EQ(expected.sizes, timeline.sizes);
}

TEST(Timeline, GoesOnWhereASegmenterThatWasStartedAgainGoesOn) {
  const std::vector<SegmentUpdate> life = life_of_two();
  std::vector<SegmentUpdate> updates = life;
  SegmentUpdate state = update_after(4, {}, {{1, 100}, {2, 35}});  // saved after four slices
  state.session = kSession + 1;
  state.sequence = 0;
  updates.push_back(state);
  for (std::size_t i = 4; i < life.size(); ++i) {
    updates.push_back(life[i]);
    updates.back().session = kSession + 1;
  }
  const SegmentTimeline expected = timeline_of(2, life);
  const SegmentTimeline timeline = timeline_of(2, updates);
  EXPECT_EQ(expected.events, timeline.events);
  EXPECT_EQ(expected.sizes, timeline.sizes);
}

TEST(Timeline, ForgetsWhatWasSaidBeforeASegmenterBeganAnew) {
  std::vector<SegmentUpdate> updates = life_of_two();
  SegmentUpdate anew = update_after(1, {{SegmentEventType::kCreated, 2}}, {{2, 7}});
  anew.session = kSession + 1;
  updates.push_back(anew);
  const SegmentTimeline timeline = timeline_of(2, updates);
  EXPECT_THAT(timeline.events, ElementsAre(Event{1, kCreated}));
  EXPECT_THAT(timeline.sizes, ElementsAre(Size{1, 7}));
}

TEST(Timeline, OfASegmentThatNobodySpokeOfIsEmpty) {
  const SegmentTimeline timeline = timeline_of(99, life_of_two());
  EXPECT_FALSE(timeline.is_known());
  EXPECT_THAT(timeline.events, IsEmpty());
  EXPECT_EQ(cv::Size(640, 480), draw_timeline(timeline, {640, 480}).size());
}

int count_of(const cv::Mat3b& image, const cv::Vec3b& color) {
  cv::Mat mask;
  cv::inRange(image, color, color, mask);
  return cv::countNonZero(mask);
}

TEST(TimelineChart, ShowsTheOthersInTheirColors) {
  const cv::Mat3b chart = draw_timeline(timeline_of(2, life_of_two()), {1280, 640});
  // Of a tag of one digit some 200 pixels are free of letters and frame.
  for (const std::uint32_t id : {1U, 2U, 3U, 4U}) {
    EXPECT_GT(count_of(chart, segment_color(id)), 150) << id;
  }
  EXPECT_EQ(0, count_of(chart, segment_color(5)));
}

TEST(TimelineChart, IsDrawnAtAnySizeWithManyEvents) {
  std::vector<SegmentUpdate> updates{
      update_after(1, {{SegmentEventType::kCreated, 1}}, {{1, 100}})};
  for (std::int32_t i = 2; i < 300; ++i) {
    const auto other = static_cast<std::uint32_t>(10 * i);
    updates.push_back(update_after(
        i, {{SegmentEventType::kMerged, 1, other}, {SegmentEventType::kSplit, 1, other + 1}},
        {{1, 100 + other}, {other + 1, 50}}));
  }
  const SegmentTimeline timeline = timeline_of(1, updates);
  for (const cv::Size size : {cv::Size(1280, 640), cv::Size(200, 200), cv::Size(4000, 300)}) {
    EXPECT_EQ(size, draw_timeline(timeline, size).size());
  }
}

TEST(TagRows, CoversNeitherOtherTagsNorTheirLines) {
  std::mt19937 random(5);
  std::vector<Tag> tags;
  for (int i = 0; i < 200; ++i) {
    const int x = std::uniform_int_distribution(100, 900)(random);
    tags.push_back({x, std::to_string(random() % 100'000), Rgb{}});
  }
  const TagRows lane(tags, 100, 900, 5);
  EXPECT_GT(lane.places().size(), 20U);  // some 16 fit into a row
  EXPECT_LE(lane.num_rows(), 5);
  for (const TagRows::Place& a : lane.places()) {
    EXPECT_GE(a.left_px, 100);
    EXPECT_LE(a.left_px + a.width_px, 900);
    for (const TagRows::Place& b : lane.places()) {
      if (a.tag == b.tag) continue;
      const int line_px = tags[b.tag].x_px;
      if (a.row == b.row) {
        EXPECT_TRUE(a.left_px + a.width_px < b.left_px || b.left_px + b.width_px < a.left_px);
      } else if (a.row < b.row && line_px != tags[a.tag].x_px) {
        EXPECT_TRUE(line_px < a.left_px || line_px > a.left_px + a.width_px);
      }
    }
  }
}

TEST(TagRows, PlacesTheFirstTagsWhenThereIsNoRoomForAll) {
  const std::vector<Tag> tags(9, {500, "12345", Rgb{}});
  const TagRows lane(tags, 100, 900, 3);
  ASSERT_EQ(3U, lane.places().size());
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(i, lane.places()[i].tag);
}

}  // namespace
}  // namespace kintsugi::viewer
