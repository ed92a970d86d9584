// What a map answers, against a look at everything it holds.

#include <algorithm>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "lcmtypes/codec/codec.hpp"
#include "segmenter/description/segment_description.hpp"
#include "segmenter/map/map_snapshot.hpp"
#include "segmenter/query/answer.hpp"
#include "tests/segmenter/process/room_session.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr double kResolution_m = 0.04;

MapSnapshot furnished_room() {
  const auto slices = testing::RoomRow(1, kResolution_m).cut(0.5);
  SegmentMap map(SegmentMapConfig{}, 3, slices.front());
  for (const CloudSlice& slice : slices) map.add({&slice, 1});
  return take_snapshot(map);
}

class Answer : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { room_ = new MapSnapshot(furnished_room()); }
  static void TearDownTestSuite() { delete room_; }

  static const MapSnapshot& room() { return *room_; }
  static SegmentQuery query(QueryPlace place) {
    SegmentQuery query;
    query.client = 8;
    query.number = 2;
    query.place = place;
    return query;
  }
  /// As a client gets it: what cannot be sent fails the test.
  static SegmentAnswer ask(const SegmentQuery& query) {
    SegmentAnswer reply = answer(room(), query);
    EXPECT_GT(num_chunks(reply, kDefaultMaxChunkBytes), 0);
    EXPECT_TRUE(std::ranges::is_sorted(reply.segments, [](const auto& a, const auto& b) {
      return a.statistics.num_points > b.statistics.num_points;
    }));
    return reply;
  }
  static std::set<std::uint32_t> ids(const SegmentAnswer& reply) {
    std::set<std::uint32_t> ids;
    for (const DescribedSegment& segment : reply.segments)
      ids.insert(segment.statistics.segment_id);
    return ids;
  }

 private:
  static MapSnapshot* room_;
};

MapSnapshot* Answer::room_ = nullptr;

TEST_F(Answer, SaysWhichMapAndWhichQueryItIsAbout) {
  const SegmentAnswer reply = ask(query(QueryPlace::kIds));
  EXPECT_EQ(reply.session, 3);
  EXPECT_EQ(reply.client, 8);
  EXPECT_EQ(reply.number, 2);
  EXPECT_EQ(reply.map_session, 5);
  EXPECT_EQ(reply.map_name, "map");
  EXPECT_EQ(reply.map_slices, std::ssize(room().state.slices));
  EXPECT_EQ(reply.map_points, std::ssize(room().state.points_W));
  EXPECT_EQ(reply.map_segments, std::ssize(room().segments));
  EXPECT_TRUE(reply.problem.empty());
  EXPECT_TRUE(reply.segments.empty());
}

TEST_F(Answer, DescribesEverySegmentAsTheDescriptionDoes) {
  const SegmentAnswer reply = ask(query(QueryPlace::kAnywhere));
  ASSERT_EQ(reply.segments.size(), room().segments.size());
  EXPECT_EQ(reply.num_matching, reply.map_segments);
  std::map<std::uint32_t, std::vector<SegmentNeighbour>> neighbours;
  for (const SegmentContact& contact : reply.contacts) {
    neighbours[contact.segment_id].push_back({contact.neighbour_id, contact.num_pairs});
  }
  for (std::size_t i = 0; i < std::min<std::size_t>(reply.segments.size(), 20); ++i) {
    const DescribedSegment& segment = reply.segments[i];
    const auto expected = describe_segment(room(), segment.statistics.segment_id);
    ASSERT_TRUE(expected);
    EXPECT_EQ(segment.statistics, expected->statistics);
    EXPECT_EQ(segment.last_change_utime, expected->last_change.utime);
    EXPECT_EQ(segment.is_planar != 0, expected->shape.is_planar);
    EXPECT_EQ(neighbours[segment.statistics.segment_id], expected->neighbours);
    const Pose& X_WB = expected->shape.box.X_WB;
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(segment.oriented_box_center_W[axis], static_cast<float>(X_WB.translation()[axis]));
      EXPECT_EQ(segment.oriented_box_size_m[axis],
                static_cast<float>(expected->shape.box.size_m[axis]));
      for (int row = 0; row < 3; ++row) {
        EXPECT_EQ(segment.oriented_box_axes_W[axis][row],
                  static_cast<float>(X_WB.linear()(row, axis)));
      }
    }
  }
}

TEST_F(Answer, OneSegmentAloneIsToldAsAmongAll) {
  const SegmentAnswer all = ask(query(QueryPlace::kAnywhere));
  SegmentQuery one = query(QueryPlace::kIds);
  one.segment_ids = {all.segments.front().statistics.segment_id, 4'000'000'000U};
  const SegmentAnswer reply = ask(one);
  ASSERT_EQ(reply.segments.size(), 1U);
  EXPECT_EQ(reply.num_matching, 1);
  EXPECT_EQ(reply.segments.front(), all.segments.front());
}

TEST_F(Answer, GivesTheLargestAndHowManyThereAre) {
  SegmentQuery largest = query(QueryPlace::kAnywhere);
  const SegmentAnswer all = ask(largest);
  largest.max_segments = 3;
  const SegmentAnswer reply = ask(largest);
  EXPECT_EQ(reply.num_matching, all.num_matching);
  ASSERT_EQ(reply.segments.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(reply.segments[i], all.segments[i]);
}

TEST_F(Answer, FindsTheFloorUnderAPoint) {
  SegmentQuery at = query(QueryPlace::kPoint);
  at.point_W[0] = 1.0;
  at.point_W[1] = 0.5;
  at.point_W[2] = 0.03;
  const SegmentAnswer reply = ask(at);
  ASSERT_TRUE(reply.has_hit);
  ASSERT_EQ(reply.segments.size(), 1U);
  EXPECT_NEAR(reply.hit_W[2], 0.0, 1e-6);
  // A plane z = 0 with its normal up; the noise of its points is in the plane.
  EXPECT_NEAR(reply.segments[0].plane_normal_W[2], 1.0, 1e-3);
  EXPECT_NEAR(reply.segments[0].plane_offset_m, 0.0, 1e-3);
  EXPECT_GT(reply.segments[0].distance_m, 0.029F);
  EXPECT_LE(reply.segments[0].distance_m, 2.0F * kResolution_m);

  at.point_W[2] = 0.5;  // in the air
  EXPECT_FALSE(ask(at).has_hit);
  EXPECT_TRUE(ask(at).segments.empty());
  at.radius_m = 0.6;
  EXPECT_TRUE(ask(at).has_hit);
}

TEST_F(Answer, SeesTheTableThatHidesTheFloor) {
  SegmentQuery down = query(QueryPlace::kRay);
  down.point_W[0] = 2.1;
  down.point_W[1] = 1.4;
  down.point_W[2] = 2.0;
  down.direction_W[2] = -1.0;
  const SegmentAnswer table = ask(down);
  ASSERT_TRUE(table.has_hit);
  EXPECT_NEAR(table.hit_W[2], 0.7, 1e-6);
  EXPECT_NEAR(table.segments.at(0).distance_m, 1.3, 5e-3);  // the disc is tilted by noise
  down.point_W[0] = 0.8;
  const SegmentAnswer floor = ask(down);
  ASSERT_TRUE(floor.has_hit);
  EXPECT_NEAR(floor.hit_W[2], 0.0, 1e-6);
  EXPECT_NE(ids(floor), ids(table));
}

TEST_F(Answer, BoxPlanarAndChangedSinceAreFiltersThatGoTogether) {
  SegmentQuery some = query(QueryPlace::kBox);
  const double box_max_W[3] = {1.6, 1.2, 0.3};
  std::copy_n(box_max_W, 3, some.box_max_W);
  some.only_planar = true;
  some.changed_since = 1'002;
  std::set<std::uint32_t> expected;
  for (std::size_t i = 0; i < room().state.points_W.size(); ++i) {
    const CloudPoint& p = room().state.points_W[i];
    if (p.x >= 0 && p.x <= 1.6 && p.y >= 0 && p.y <= 1.2 && p.z >= 0 && p.z <= 0.3) {
      expected.insert(room().state.segment_ids[i]);
    }
  }
  const std::size_t num_in_box = expected.size();
  std::erase_if(expected, [](std::uint32_t id) {
    const auto segment = describe_segment(room(), id);
    return !segment->shape.is_planar || segment->last_change.utime <= 1'002;
  });
  ASSERT_FALSE(expected.empty());
  ASSERT_LT(expected.size(), num_in_box);
  EXPECT_EQ(ids(ask(some)), expected);
  some.max_segments = 1;
  EXPECT_EQ(ask(some).num_matching, std::ssize(expected));
  EXPECT_EQ(ask(some).segments.size(), 1U);
}

TEST_F(Answer, NothingChangesAfterTheLastSlice) {
  SegmentQuery changed = query(QueryPlace::kAnywhere);
  changed.changed_since = 1'000 + std::ssize(room().state.slices) - 1;  // the utime of the last
  EXPECT_TRUE(ask(changed).segments.empty());
  --changed.changed_since;
  EXPECT_FALSE(ask(changed).segments.empty());
}

}  // namespace
}  // namespace kintsugi::segmenter
