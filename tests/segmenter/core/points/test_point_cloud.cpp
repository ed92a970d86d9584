#include <algorithm>
#include <map>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "segmenter/core/points/point_cloud.hpp"
#include "tests/segmenter/core/random_clouds.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

CloudPoint point(float x) { return testing::make_point(x, 0, 0, 0, 0, 1); }
CloudPoint bad_point() { return point(NAN); }

TEST(PointCloud, KeepsPointsInOrderOfArrival) {
  PointCloud cloud;
  cloud.add_slice(3, std::vector{point(1), point(2)});
  const SliceRecord& record = cloud.add_slice(1, std::vector{point(3)});
  EXPECT_EQ(record.first, 2U);
  EXPECT_EQ(record.count, 1U);
  ASSERT_EQ(cloud.size(), 3U);
  EXPECT_EQ(cloud[0], point(1));
  EXPECT_EQ(cloud[2], point(3));
  EXPECT_EQ(cloud.id_of(1), (PointId{3, 1}));
  EXPECT_EQ(cloud.id_of(2), (PointId{1, 0}));
}

TEST(PointCloud, RejectedPointsAreRecordedAndLeftOut) {
  PointCloud cloud;
  const SliceRecord& record =
      cloud.add_slice(0, std::vector{bad_point(), point(1), bad_point(), bad_point(), point(2)});
  EXPECT_EQ(record.num_points, 5);
  EXPECT_THAT(record.rejected, ElementsAre(0, 2, 3));
  EXPECT_EQ(cloud.num_rejected(), 3);
  ASSERT_EQ(cloud.size(), 2U);
  EXPECT_EQ(cloud.id_of(0), (PointId{0, 1}));
  EXPECT_EQ(cloud.id_of(1), (PointId{0, 4}));
}

TEST(PointCloud, IdsNameThePointsAsTheyCame) {
  std::mt19937 generator(1);
  PointCloud cloud;
  std::vector<PointId> expected;
  for (std::int32_t slice_id = 0; slice_id < 20; ++slice_id) {
    std::vector<CloudPoint> points;
    const auto num_points = static_cast<std::int32_t>(generator() % 10);  // empty ones among them
    for (std::int32_t index = 0; index < num_points; ++index) {
      const bool is_bad = generator() % 3 == 0;
      points.push_back(is_bad ? bad_point() : point(0));
      if (!is_bad) expected.push_back({slice_id, index});
    }
    cloud.add_slice(slice_id, points);
  }
  ASSERT_EQ(cloud.size(), expected.size());
  for (PointIndex i = 0; i < cloud.size(); ++i) EXPECT_EQ(cloud.id_of(i), expected[i]);
}

TEST(PointCloud, RefusesASliceIdTwiceOrBelowZero) {
  PointCloud cloud;
  cloud.add_slice(5, std::vector{point(0)});
  EXPECT_THROW(cloud.add_slice(5, std::vector{point(1)}), std::invalid_argument);
  EXPECT_THROW(cloud.add_slice(-1, std::vector{point(1)}), std::invalid_argument);
  EXPECT_EQ(cloud.size(), 1U);
  EXPECT_EQ(cloud.slices().size(), 1U);
}

TEST(PointCloud, TellsWhichPointsOfARevisionMoved) {
  PointCloud cloud;
  cloud.add_slice(0, std::vector{point(1), bad_point(), point(2), point(3)});
  cloud.add_slice(1, std::vector{point(4)});
  cloud.take_change();
  const SliceRecord& record =
      cloud.replace_slice(0, std::vector{point(11), point(12), bad_point(), point(13), point(14)});
  EXPECT_EQ(record.revision, 1);
  EXPECT_EQ(record.num_points, 5);
  EXPECT_EQ(record.first, 4U);
  EXPECT_EQ(cloud.num_live(), 5U);
  EXPECT_EQ(cloud.num_rejected(), 1);

  const CloudChange change = cloud.take_change();
  EXPECT_THAT(change.removed, ElementsAre(0, 1, 2));
  EXPECT_THAT(change.added, ElementsAre(4, 5, 6, 7));
  EXPECT_THAT(change.moved, ElementsAre(MovedPoint{0, 4}, MovedPoint{2, 6}));
  // Removed points can still be read.
  EXPECT_FALSE(cloud.is_live(1));
  EXPECT_EQ(cloud[1], point(2));
  EXPECT_EQ(cloud.id_of(1), (PointId{0, 2}));
  EXPECT_EQ(cloud.slice_of(1).revision, 0);
  EXPECT_THAT(cloud.everything().added, ElementsAre(3, 4, 5, 6, 7));
  EXPECT_THAT(cloud.everything().removed, IsEmpty());
}

TEST(PointCloud, UsesFreePlacesAgainOnceTheChangeWasTaken) {
  PointCloud cloud;
  cloud.add_slice(0, std::vector{point(1), point(2), point(3)});
  cloud.take_change();
  cloud.replace_slice(0, std::vector{point(4), point(5), point(6)});
  EXPECT_EQ(cloud.add_slice(1, std::vector{point(7)}).first, 6U);  // 0 to 2 are not told of yet
  cloud.take_change();
  EXPECT_EQ(cloud.add_slice(2, std::vector{point(8)}).first, 0U);
  EXPECT_EQ(cloud.add_slice(3, std::vector{point(9), point(9), point(9)}).first, 7U);
  EXPECT_EQ(cloud.add_slice(4, std::vector{point(10), point(11)}).first, 1U);
  EXPECT_EQ(cloud.size(), 10U);
  EXPECT_EQ(cloud.id_of(0), (PointId{2, 0}));
  EXPECT_EQ(cloud.id_of(4), (PointId{0, 1}));
}

TEST(PointCloud, DoesNotGrowWithEveryCorrection) {
  PointCloud cloud;
  for (std::int32_t slice = 0; slice < 5; ++slice) cloud.add_slice(slice, std::vector(7, point(1)));
  cloud.take_change();
  for (int round = 0; round < 50; ++round) {
    for (std::int32_t slice = 0; slice < 5; ++slice) {
      cloud.replace_slice(slice, std::vector(7, point(2)));
    }
    cloud.take_change();
  }
  EXPECT_EQ(cloud.num_live(), 35U);
  EXPECT_EQ(cloud.size(), 70U);
}

PatchPlace place_at(float x, std::int32_t correction) {
  PatchPlace place;
  place.X_WP.t_WP[0] = x;
  place.correction = correction;
  return place;
}

TEST(PointCloud, PointsThatMoveInPlaceKeepTheirIndices) {
  PointCloud cloud;
  for (std::int32_t slice = 0; slice < 3; ++slice) {
    cloud.add_slice(slice, std::vector{point(1), bad_point(), point(2)}, 0, PatchState::kInVolume);
  }
  cloud.take_change();
  cloud.move_in_place(std::vector<PlacedPatch>{{2, place_at(8, 1)}, {0, place_at(4, 1)}});
  CloudChange change = cloud.take_change();
  EXPECT_THAT(change.added, IsEmpty());
  EXPECT_THAT(change.removed, IsEmpty());
  EXPECT_THAT(change.moved, IsEmpty());
  EXPECT_THAT(change.moved_in_place, ElementsAre(PointRange{0, 2}, PointRange{4, 2}));
  EXPECT_EQ(cloud[1], point(6));
  EXPECT_EQ(cloud[2], point(1));
  EXPECT_EQ(cloud[4], point(9));
  EXPECT_EQ(cloud.find_slice(0)->place, place_at(4, 1));
  EXPECT_EQ(cloud.find_slice(1)->place, PatchPlace{});

  // Back where they were received: nothing is kept besides.
  cloud.move_in_place(std::vector<PlacedPatch>{{0, place_at(0, 2)}});
  change = cloud.take_change();
  EXPECT_THAT(change.moved_in_place, ElementsAre(PointRange{0, 2}));
  EXPECT_EQ(cloud[1], point(2));
  EXPECT_EQ(cloud.find_slice(0)->points_P, nullptr);
  EXPECT_NE(cloud.find_slice(2)->points_P, nullptr);
  EXPECT_THAT(cloud.take_change().moved_in_place, IsEmpty());
}

TEST(PointCloud, WhereOneSliceIsNotThereNoneMovesInPlace) {
  PointCloud cloud;
  cloud.add_slice(0, std::vector{point(1)}, 0, PatchState::kInVolume);
  cloud.take_change();
  const std::vector<PlacedPatch> slices{{0, place_at(4, 1)}, {7, place_at(4, 1)}};
  EXPECT_THROW(cloud.move_in_place(slices), std::invalid_argument);
  EXPECT_EQ(cloud[0], point(1));
  EXPECT_THAT(cloud.take_change().moved_in_place, IsEmpty());
}

TEST(PointCloud, RefusesToReplaceWhatIsNotThereOrNotNewer) {
  PointCloud cloud;
  cloud.add_slice(5, std::vector{point(0)}, 3);
  EXPECT_THROW(cloud.replace_slice(4, {}), std::invalid_argument);
  EXPECT_THROW(cloud.replace_slice(5, {}, 3), std::invalid_argument);
  EXPECT_EQ(cloud.slices()[0].revision, 3);
  EXPECT_EQ(cloud.num_live(), 1U);
}

/// Applies the changes as an engine does, and checks that they are consistent.
class Follower {
 public:
  void apply(const PointCloud& cloud, const CloudChange& change) {
    std::map<PointIndex, PointIndex> moved_from;
    for (const MovedPoint& moved : change.moved) moved_from[moved.to] = moved.from;
    std::map<PointIndex, PointId> removed;
    for (const PointIndex p : change.removed) {
      ASSERT_TRUE(live_.contains(p));
      const auto& [id, x] = live_.at(p);
      EXPECT_EQ(cloud[p].x, x) << "not readable any more";
      EXPECT_EQ(cloud.id_of(p), id);
      removed[p] = id;
      live_.erase(p);
    }
    for (const PointIndex p : change.added) {
      const PointId id = cloud.id_of(p);
      EXPECT_TRUE(live_.try_emplace(p, id, cloud[p].x).second) << "its place is taken";
      const auto before = std::find_if(removed.begin(), removed.end(),
                                       [&](const auto& entry) { return entry.second == id; });
      ASSERT_EQ(moved_from.contains(p), before != removed.end());
      if (before != removed.end()) {
        EXPECT_EQ(moved_from.at(p), before->first);
      }
    }
  }
  std::map<PointIndex, std::pair<PointId, float>> live_;
};

TEST(PointCloud, RandomChangesAreToldInFull) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    std::mt19937 generator(seed);
    PointCloud cloud;
    Follower follower;
    std::map<std::int32_t, std::vector<float>> expected;  // by slice, NAN: rejected
    float next = 0.0F;
    for (int step = 0; step < 120; ++step) {
      const auto slice_id = static_cast<std::int32_t>(generator() % 12);
      std::vector<CloudPoint> points;
      std::vector<float> values;
      for (unsigned k = generator() % 8; k > 0; --k) {
        values.push_back(generator() % 4 == 0 ? NAN : ++next);
        points.push_back(point(values.back()));
      }
      if (!expected.contains(slice_id)) {
        cloud.add_slice(slice_id, points);
        expected[slice_id] = values;
      } else if (generator() % 3 == 0) {
        cloud.replace_slice(slice_id, {});
        expected[slice_id].clear();
      } else {
        cloud.replace_slice(slice_id, points);
        expected[slice_id] = values;
      }
      if (generator() % 3 != 0) continue;

      follower.apply(cloud, cloud.take_change());
      std::map<PointId, float> live;
      for (const auto& [p, named] : follower.live_) {
        EXPECT_TRUE(cloud.is_live(p));
        EXPECT_EQ(cloud.id_of(p), named.first);
        live[named.first] = named.second;
      }
      std::map<PointId, float> expected_live;
      for (const auto& [id, in_slice] : expected) {
        for (std::size_t k = 0; k < in_slice.size(); ++k) {
          if (in_slice[k] == in_slice[k]) {
            expected_live[{id, static_cast<std::int32_t>(k)}] = in_slice[k];
          }
        }
      }
      EXPECT_EQ(live, expected_live);
      EXPECT_EQ(cloud.num_live(), live.size());
      EXPECT_EQ(cloud.slices().size(), expected.size());
      EXPECT_EQ(cloud.everything().added.size(), live.size());
    }
    EXPECT_LT(cloud.size(), 12U * 7U * 4U);
  }
}

TEST(FreeRanges, JoinAndAreTakenFromTheFirstThatFits) {
  FreeRanges ranges;
  EXPECT_EQ(ranges.take(1), std::nullopt);
  ranges.release(10, 5);
  ranges.release(20, 5);
  EXPECT_EQ(ranges.take(6), std::nullopt);
  ranges.release(15, 5);
  EXPECT_EQ(ranges.take(6), 10U);
  ranges.release(5, 3);
  EXPECT_EQ(ranges.take(4), 16U);
  EXPECT_EQ(ranges.take(3), 5U);
  EXPECT_EQ(ranges.take(5), 20U);
  EXPECT_EQ(ranges.take(1), std::nullopt);
}

}  // namespace
}  // namespace kintsugi::segmenter
