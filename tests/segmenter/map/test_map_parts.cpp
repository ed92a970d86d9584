#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "segmenter/map/map_parts.hpp"
#include "tests/segmenter/process/slice_session.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::ElementsAre;

class MapParts : public ::testing::Test {
 protected:
  void add(const CloudSlice& slice) { map_.add({&slice, 1}); }
  MapSnapshot snapshot() const { return take_snapshot(map_); }

  std::vector<CloudSlice> slices_ = testing::session_in_two_parts();
  SegmentMap map_{{}, 77, slices_[0]};
};

std::vector<std::int32_t> slice_ids(const MapSnapshot& map) {
  std::vector<std::int32_t> ids;
  for (const SliceRecord& slice : map.state.slices) ids.push_back(slice.slice_id);
  return ids;
}

TEST_F(MapParts, AreThoseWithPoints) {
  EXPECT_THAT(parts_of(snapshot()), ElementsAre(0)) << "also of a map without points";
  slices_[3].points_W.clear();
  add(slices_[3]);
  add(slices_[4]);
  EXPECT_THAT(parts_of(snapshot()), ElementsAre(0));
  add(slices_[2]);
  EXPECT_THAT(parts_of(snapshot()), ElementsAre(0, 1)) << "part 0 even without points";
}

TEST_F(MapParts, TogetherAreTheMap) {
  // In turns, so that what is of one part does not lie in one piece.
  for (const std::size_t i : {2U, 0U, 3U, 1U, 4U}) add(slices_[i]);
  const MapSnapshot whole = snapshot();
  const MapSnapshot part0 = only_part(whole, 0);
  const MapSnapshot part1 = only_part(whole, 1);
  EXPECT_THAT(slice_ids(part0), ElementsAre(0, 1));
  EXPECT_THAT(slice_ids(part1), ElementsAre(2, 3, 4));
  EXPECT_EQ(part0.state.points_W.size() + part1.state.points_W.size(), whole.state.points_W.size());
  EXPECT_EQ(part0.segments.size() + part1.segments.size(), whole.segments.size());
  ASSERT_FALSE(part0.segments.empty());

  for (const MapSnapshot* const part : {&part0, &part1}) {
    EXPECT_TRUE(part->is_complete);
    EXPECT_EQ(part->state.map_session, whole.state.map_session);
    EXPECT_EQ(part->state.session, 77);
    EXPECT_EQ(part->state.map_name, "map");
    EXPECT_EQ(part->state.config.engine.resolution_m, whole.state.config.engine.resolution_m);
    // What is known of the segments is what counting anew gives.
    const MapSnapshot counted = make_snapshot(part->state);
    EXPECT_EQ(counted.segments, part->segments);
    EXPECT_EQ(counted.is_complete, false) << "its slices are not all of the map";
  }
}

TEST_F(MapParts, HaveTheirOwnPointsAndRejectedPoints) {
  for (const CloudSlice& slice : slices_) add(slice);
  const MapSnapshot part1 = only_part(snapshot(), 1);
  ASSERT_EQ(part1.state.points_W.size(), 2 * slices_[2].points_W.size() - 2);
  EXPECT_EQ(part1.state.slices[1].first, slices_[2].points_W.size() - 1);
  for (const CloudPoint& point : part1.state.points_W) EXPECT_GT(point.x, 900.0F);
  for (const CloudPoint& point : only_part(snapshot(), 0).state.points_W) {
    EXPECT_LT(point.x, 100.0F);
  }
  EXPECT_THAT(part1.state.slices[0].rejected, ElementsAre(0));
}

TEST_F(MapParts, HaveTheLastChangesOfTheirSegments) {
  for (const CloudSlice& slice : slices_) add(slice);
  const MapSnapshot whole = snapshot();
  const MapSnapshot part1 = only_part(whole, 1);
  ASSERT_EQ(part1.state.last_changes.size(), part1.segments.size());
  for (const LastChange& change : part1.state.last_changes) EXPECT_GE(change.slice_id, 2);

  MapSnapshot without = whole;
  without.state.last_changes.clear();
  EXPECT_TRUE(only_part(without, 1).state.last_changes.empty());
  EXPECT_EQ(only_part(without, 1).segments, part1.segments);
}

TEST_F(MapParts, OfAJoinedPartNothingIsLeft) {
  for (const CloudSlice& slice : slices_) add(slice);
  add(testing::correction_that_joins());
  EXPECT_THAT(parts_of(snapshot()), ElementsAre(0));
  const MapSnapshot part0 = only_part(snapshot(), 0);
  EXPECT_EQ(part0.state.points_W, snapshot().state.points_W);
  EXPECT_EQ(part0.segments, snapshot().segments);
}

}  // namespace
}  // namespace kintsugi::segmenter
