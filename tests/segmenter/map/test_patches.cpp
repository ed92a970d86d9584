// Patches: surface that is sent again while it is scanned keeps its segments.

#include <algorithm>
#include <random>
#include <span>

#include <gmock/gmock.h>

#include "segmenter/core/parameters/presets.hpp"
#include "segmenter/map/map_snapshot.hpp"
#include "segmenter/map/segment_map.hpp"
#include "tests/segmenter/process/slice_session.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::AllOf;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::IsEmpty;
using testing::LabelMirror;

constexpr double kVoxel_m = 0.01;

CloudSlice patch(std::int32_t id, std::int32_t revision, std::vector<CloudPoint> points_W) {
  CloudSlice slice;
  slice.utime = 1000 + revision;
  slice.session = 5;
  slice.map_name = "map";
  slice.id = id;
  slice.revision = revision;
  slice.kind = SliceKind::kPatch;
  slice.in_volume = true;
  slice.resolution_m = static_cast<float>(kVoxel_m);
  slice.points_W = std::move(points_W);
  return slice;
}

class Patches : public ::testing::Test {
 protected:
  /// `num_x` times `num_y` points of a plane at height `z`, in voxels, from (`x`, `y`) on: one in
  /// the middle of each voxel, moved by at most `jitter`, in any order.
  std::vector<CloudPoint> plane(int x, int y, int num_x, int num_y, double z, double jitter = 0.0) {
    std::uniform_real_distribution<double> noise(-jitter, jitter);
    std::vector<CloudPoint> points_W;
    for (int i = x; i < x + num_x; ++i) {
      for (int j = y; j < y + num_y; ++j) {
        const double u = kVoxel_m * (i + 0.5 + noise(random_));
        const double v = kVoxel_m * (j + 0.5 + noise(random_));
        points_W.push_back(testing::make_point(u, v, kVoxel_m * (z + noise(random_)), 0, 0, 1));
      }
    }
    std::ranges::shuffle(points_W, random_);
    return points_W;
  }

  SegmentUpdate add(const std::vector<CloudSlice>& slices) {
    if (!map_) {
      SegmentMapConfig config;
      config.engine = preset("objects");
      map_ = std::make_unique<SegmentMap>(config, 9, slices[0]);
    }
    SegmentUpdate last;
    for (const SegmentUpdate& update : map_->add(slices)) {
      mirror_.apply(update);
      last = update;
    }
    EXPECT_EQ(mirror_.labels(), testing::labels_of(*map_));
    EXPECT_EQ(mirror_.statistics(), map_->statistics().all());
    EXPECT_EQ(make_snapshot(map_->state()).segments, map_->statistics().all());
    return last;
  }

  std::mt19937 random_{3};
  std::unique_ptr<SegmentMap> map_;
  LabelMirror mirror_;
};

TEST_F(Patches, APlaneThatOnlyGetsBetterPointsKeepsItsIdAndGivesNoEvent) {
  add({patch(0, 0, plane(0, 0, 25, 25, 0.5, 0.4))});
  for (std::int32_t revision = 1; revision <= 10; ++revision) {
    const SegmentUpdate update = add({patch(0, revision, plane(0, 0, 25, 25, 0.5, 0.4))});
    EXPECT_THAT(update.events, IsEmpty()) << revision;
    EXPECT_THAT(update.labels, AllOf(::testing::SizeIs(625), Each(1U)));
  }
  EXPECT_EQ(map_->segment_ids().next_id(), 2U);
}

TEST_F(Patches, SoDoesAPlaneOnTheFacesOfVoxels) {
  add({patch(0, 0, plane(0, 0, 25, 25, 0.0, 0.2))});
  for (std::int32_t revision = 1; revision <= 10; ++revision) {
    const double z = revision % 2 == 0 ? 0.25 : -0.25;  // all points cross
    EXPECT_THAT(add({patch(0, revision, plane(0, 0, 25, 25, z, 0.2))}).events, IsEmpty());
  }
}

TEST_F(Patches, ABookThatGrowsKeepsItsId) {
  add({patch(0, 0, plane(0, 0, 25, 10, 0.5, 0.3))});
  for (std::int32_t revision = 1; revision <= 20; ++revision) {
    // It reaches into the next patch, and its edges are not the same twice.
    const std::vector<CloudSlice> batch = {
        patch(0, revision, plane(0, 0, 25, 10 + revision, 0.5, 0.3)),
        patch(1, revision, plane(25, 0, 3 + revision % 2, 10 + revision, 0.5, 0.3))};
    EXPECT_THAT(add(batch).events, ElementsAre(SegmentEvent{SegmentEventType::kGrown, 1, 0}))
        << revision;
  }
  EXPECT_EQ(map_->segment_ids().num_segments(), 1);
}

TEST_F(Patches, OnlyWhatIsGoneIsRetired) {
  add({patch(0, 0, plane(0, 0, 20, 20, 0.5)), patch(1, 0, plane(60, 0, 20, 20, 0.5))});
  EXPECT_EQ(map_->segment_ids().num_segments(), 2);
  EXPECT_THAT(add({patch(0, 1, {}), patch(1, 1, plane(60, 0, 20, 20, 0.5, 0.3))}).events,
              ElementsAre(Field(&SegmentEvent::type, SegmentEventType::kRetired)));
}

TEST_F(Patches, ThePointsInTheVolumeAreCounted) {
  std::vector<CloudSlice> slices = {patch(0, 0, plane(0, 0, 20, 10, 0.5)),
                                    patch(1, 0, plane(0, 10, 20, 20, 0.5))};
  add(slices);
  EXPECT_EQ(map_->statistics()(1).points_in_volume, 600U);
  slices[0].revision = 1;
  slices[0].in_volume = false;
  EXPECT_EQ(add({slices[0]}).statistics.at(0).points_in_volume, 400U);
  slices[1].revision = 1;
  slices[1].in_volume = false;
  EXPECT_EQ(add({slices[1]}).statistics.at(0).points_in_volume, 0U);
  EXPECT_EQ(map_->statistics()(1).num_points, 600U);
}

TEST_F(Patches, TheMapIsCompleteWithEveryIdAndRevision) {
  CloudSlice last = patch(2, 0, {});
  last.kind = SliceKind::kFinal;
  last.revision_sum = 3;
  EXPECT_FALSE(add({patch(0, 1, plane(0, 0, 9, 9, 0.5)), last}).is_final);
  EXPECT_TRUE(map_->has_final_slice());
  EXPECT_FALSE(add({patch(1, 0, plane(20, 0, 9, 9, 0.5))}).is_final);
  EXPECT_FALSE(make_snapshot(map_->state()).is_complete);
  EXPECT_TRUE(add({patch(0, 3, plane(0, 0, 9, 9, 0.5))}).is_final);
  EXPECT_TRUE(make_snapshot(map_->state()).is_complete);
  EXPECT_TRUE(SegmentMap(map_->state()).is_complete());
}

}  // namespace
}  // namespace kintsugi::segmenter
