// Answers from an excerpt of a map that was corrected, against those from a copy of all of it.

#include <gtest/gtest.h>

#include "segmenter/map/map_snapshot.hpp"
#include "segmenter/query/answer.hpp"
#include "segmenter/query/map_excerpt.hpp"
#include "tests/segmenter/process/room_session.hpp"
#include "tests/segmenter/query/camera_view.hpp"

namespace kintsugi::segmenter {
namespace {

class Excerpt : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    const auto slices = testing::RoomRow(1, 0.04).cut(0.5);
    map_ = new SegmentMap(SegmentMapConfig{}, 3, slices.front());
    for (const CloudSlice& slice : slices) map_->add({&slice, 1});
    // Corrected slices have other places in the cloud than in a snapshot.
    const std::vector corrected{testing::moved(slices[1], testing::small_motion()),
                                testing::moved(slices[4], testing::small_motion())};
    map_->add(corrected);
  }
  static void TearDownTestSuite() { delete map_; }

  static SegmentQuery query(QueryPlace place) {
    SegmentQuery query;
    query.client = 8;
    query.place = place;
    return query;
  }
  static SegmentAnswer expect_same(const SegmentQuery& query, const CameraView* view = nullptr) {
    EXPECT_TRUE(needs_excerpt(query));
    MapExcerpt excerpt;
    take_excerpt(*map_, query, view, excerpt);
    const SegmentAnswer of_map = answer(take_snapshot(*map_), query, view);
    EXPECT_TRUE(answer(excerpt, query) == of_map);
    return of_map;
  }

  static SegmentMap* map_;
};

SegmentMap* Excerpt::map_ = nullptr;

TEST_F(Excerpt, AnswersAboutAPointAsTheMapDoes) {
  SegmentQuery at = query(QueryPlace::kPoint);
  int num_found = 0;
  for (const double x : {0.3, 0.8, 1.6, 2.1, 3.7}) {
    for (const double z : {0.0, 0.7, 1.5}) {
      at.point_W[0] = x;
      at.point_W[1] = 1.4;
      at.point_W[2] = z;
      num_found += static_cast<int>(expect_same(at).segments.size());
    }
  }
  EXPECT_GT(num_found, 4);
}

TEST_F(Excerpt, AnswersAboutARayAndIdsAsTheMapDoes) {
  SegmentQuery down = query(QueryPlace::kRay);
  down.point_W[0] = 2.1;
  down.point_W[1] = 1.4;
  down.point_W[2] = 2.0;
  down.direction_W[2] = -1.0;
  const SegmentAnswer table = expect_same(down);
  ASSERT_EQ(table.segments.size(), 1U);
  SegmentQuery ids = query(QueryPlace::kIds);
  ids.segment_ids = {table.segments[0].statistics.segment_id, 5, 5, 4'000'000'000U};
  EXPECT_EQ(expect_same(ids).segments.size(), 2U);
  ids.only_planar = true;
  expect_same(ids);
  ids.changed_since = 1'003;
  expect_same(ids);
}

TEST_F(Excerpt, AnswersAboutAPixelAsTheMapDoes) {
  SegmentQuery pixel = query(QueryPlace::kPixel);
  pixel.pixel_px[0] = 320;
  pixel.pixel_px[1] = 240;
  EXPECT_EQ(expect_same(pixel).view_utime, 0);

  // Above the table, which is at a height of 0.7 m.
  const Pose X_WC = testing::looking_down(2.1, 1.4, 2.0);
  CameraView view = testing::view_of_wall(5, X_WC, 1.3);
  const SegmentAnswer table = expect_same(pixel, &view);
  ASSERT_EQ(table.segments.size(), 1U);
  EXPECT_NEAR(table.hit_W[2], 0.7, 0.03);
  EXPECT_NEAR(table.surface_distance_m, 1.3, 1e-3);
  EXPECT_NEAR(table.segments[0].distance_m, 1.3, 0.03);
  EXPECT_EQ(table.view_utime, view.utime);

  // A thing on the table that no slice has brought yet hides it.
  view = testing::view_of_wall(5, X_WC, 1.1);
  const SegmentAnswer thing = expect_same(pixel, &view);
  EXPECT_FALSE(thing.has_hit);
  EXPECT_TRUE(thing.segments.empty());
  EXPECT_NEAR(thing.surface_distance_m, 1.1, 1e-3);

  // The floor below, where the table was until now.
  view = testing::view_of_wall(5, X_WC, 2.0);
  EXPECT_NEAR(expect_same(pixel, &view).hit_W[2], 0.0, 0.03);

  view = testing::blind_view(5, X_WC);
  const SegmentAnswer nothing = expect_same(pixel, &view);
  EXPECT_EQ(nothing.view_utime, view.utime);
  EXPECT_EQ(nothing.surface_distance_m, 0.0F);
  EXPECT_FALSE(nothing.has_hit);
}

TEST_F(Excerpt, HasOnlyWhatDescribesTheSegment) {
  SegmentQuery at = query(QueryPlace::kPoint);
  at.point_W[0] = 2.1;
  at.point_W[1] = 1.4;
  at.point_W[2] = 0.7;
  MapExcerpt excerpt;
  take_excerpt(*map_, at, nullptr, excerpt);
  EXPECT_EQ(excerpt.map_points, map_->cloud().num_live());
  EXPECT_GT(excerpt.points_W.size(), 0U);
  EXPECT_LT(4 * excerpt.points_W.size(), map_->cloud().num_live());
}

}  // namespace
}  // namespace kintsugi::segmenter
