#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "segmenter/map/segment_statistics.hpp"

namespace kintsugi::segmenter {
namespace {

CloudPoint random_point(std::mt19937& random) {
  std::uniform_real_distribution<float> coordinate(-3.0F, 3.0F);
  CloudPoint point;
  // A coarse lattice: many points on the faces of their segment's box.
  point.x = std::round(coordinate(random) * 4.0F) / 4.0F;
  point.y = coordinate(random);
  point.z = coordinate(random);
  const float angle = coordinate(random);
  point.nx = std::cos(angle);
  point.ny = std::sin(angle);
  point.red = static_cast<std::uint8_t>(random());
  point.green = static_cast<std::uint8_t>(random());
  return point;
}

// Names the component of each point by its smallest point, as the engines do.
std::vector<PointIndex> representatives(const std::vector<int>& component) {
  std::map<int, PointIndex> smallest;
  std::vector<PointIndex> result;
  for (PointIndex i = 0; i < component.size(); ++i) {
    result.push_back(smallest.try_emplace(component[i], i).first->second);
  }
  return result;
}

std::vector<PointIndex> differences(const std::vector<PointIndex>& before,
                                    const std::vector<PointIndex>& after) {
  std::vector<PointIndex> changed;
  for (PointIndex i = 0; i < after.size(); ++i) {
    if (i >= before.size() || before[i] != after[i]) {
      changed.push_back(i);
    }
  }
  return changed;
}

// The table of the same partition, built in one go.
std::vector<SegmentStatistics> from_scratch(const PointCloud& cloud, const SegmentIds& ids,
                                            float resolution_m) {
  SegmentStatisticsTable table(resolution_m);
  std::vector<IdChange> changes;
  for (const PointIndex i : cloud.everything().added) {
    changes.push_back({i, kNoSegment, ids.ids()[i]});
  }
  table.apply(cloud, ids, changes);
  return table.all();
}

TEST(SegmentStatistics, EqualThoseFromScratchAfterEveryChange) {
  std::mt19937 random(7);
  constexpr float kResolution_m = 0.02F;
  PointCloud cloud;
  SegmentIds ids;
  SegmentStatisticsTable table(kResolution_m);
  std::vector<int> component;
  std::vector<PointIndex> before;
  for (int slice = 0; slice < 40; ++slice) {
    std::vector<CloudPoint> points;
    for (int i = 0; i < 25; ++i) {
      points.push_back(random_point(random));
      component.push_back(static_cast<int>(random() % 12));
    }
    cloud.add_slice(slice, points);
    for (int i = 0; i < 20; ++i) {  // points that change segment
      component[random() % component.size()] = static_cast<int>(random() % 12);
    }
    const auto after = representatives(component);
    const CloudChange change = cloud.take_change();
    const IdUpdate update = ids.update(cloud, change, after, differences(before, after));
    table.apply(cloud, ids, update.changes);
    before = after;
    EXPECT_EQ(table.all(), from_scratch(cloud, ids, kResolution_m)) << "slice " << slice;
  }
}

// Segments of some thousand points, which keep their extents by blocks, shrink to a few and grow
// again; slices move and go, so faces of boxes are lost all the time.
TEST(SegmentStatistics, OfLargeSegmentsEqualThoseFromScratchUnderCorrections) {
  std::mt19937 random(9);
  PointCloud cloud;
  SegmentIds ids;
  SegmentStatisticsTable table(0.01F);
  std::map<PointId, ComponentId> component;
  std::vector<ComponentId> before;
  for (int step = 0; step < 60; ++step) {
    for (int k = 0; k < 3; ++k) {
      const auto slice = static_cast<std::int32_t>(random() % 15);
      std::vector<CloudPoint> points;
      for (auto i = random() % 700; i > 0; --i) points.push_back(random_point(random));
      if (cloud.find_slice(slice) == nullptr) {
        cloud.add_slice(slice, points);
      } else if (random() % 4 == 0) {
        cloud.replace_slice(slice, {});
      } else {
        cloud.replace_slice(slice, points);
      }
    }
    const CloudChange change = cloud.take_change();
    const ComponentId favourite = random() % 4;
    std::vector<ComponentId> after(cloud.size(), kNoComponent);
    for (const PointIndex i : cloud.everything().added) {
      const auto [known, is_new] = component.try_emplace(cloud.id_of(i), favourite);
      if (random() % 10 == 0) known->second = step % 20 < 10 ? favourite : random() % 4;
      after[i] = known->second;
    }
    std::vector<PointIndex> changed = change.added;
    for (PointIndex i = 0; i < before.size(); ++i) {
      const bool is_added = std::binary_search(change.added.begin(), change.added.end(), i);
      if (after[i] != kNoComponent && after[i] != before[i] && !is_added) changed.push_back(i);
    }
    std::sort(changed.begin(), changed.end());
    table.apply(cloud, ids, ids.update(cloud, change, after, changed).changes);
    before = after;
    ASSERT_EQ(table.all(), from_scratch(cloud, ids, 0.01F)) << "step " << step;
  }
}

// The points of some slices move in place while others change segment; in between slices are
// replaced, so that what recount() leaves behind is used by apply().
TEST(SegmentStatistics, EqualThoseFromScratchWherePointsMoveInPlace) {
  std::mt19937 random(11);
  PointCloud cloud;
  SegmentIds ids;
  SegmentStatisticsTable table(0.01F);
  std::vector<ComponentId> before;
  const auto some_points = [&] {
    std::vector<CloudPoint> points(300);
    std::ranges::generate(points, [&] { return random_point(random); });
    return points;
  };
  for (std::int32_t slice = 0; slice < 20; ++slice) {
    cloud.add_slice(slice, some_points(), 0, PatchState::kInVolume);
  }
  for (int step = 0; step < 30; ++step) {
    if (step % 3 == 1) {
      cloud.replace_slice(static_cast<std::int32_t>(random() % 20), some_points());
    } else if (step > 0) {
      std::vector<PlacedPatch> moving;
      for (std::int32_t slice = 0; slice < 20; ++slice) {
        if (random() % 2 == 0) continue;
        PatchPlace place{.X_WP = {}, .correction = step};
        place.X_WP.t_WP[2] = static_cast<float>(random() % 8);
        moving.push_back({slice, place});
      }
      cloud.move_in_place(moving);
    }
    const CloudChange change = cloud.take_change();
    before.resize(cloud.size(), kNoComponent);
    for (const PointIndex i : change.removed) before[i] = kNoComponent;
    std::vector<ComponentId> after = before;
    for (const PointIndex i : cloud.everything().added) {
      if (after[i] == kNoComponent || random() % 20 == 0) {
        after[i] = random() % 3 == 0 ? static_cast<ComponentId>(3 + random() % 9) : random() % 3;
      }
    }
    const IdUpdate update = ids.update(cloud, change, after, differences(before, after));
    if (change.moved_in_place.empty()) {
      table.apply(cloud, ids, update.changes);
    } else {
      table.recount(cloud, ids, update.changes, change.moved_in_place);
    }
    before = after;
    ASSERT_EQ(table.all(), from_scratch(cloud, ids, 0.01F)) << "step " << step;
  }
}

TEST(SegmentStatistics, HaveTheValuesOfClosedForm) {
  PointCloud cloud;
  CloudPoint a{0.5F, -1.0F, 2.0F, 1.0F, 0.0F, 0.0F, 10, 20, 30, 0, 1.0F};
  CloudPoint b{1.5F, -3.0F, 2.0F, 0.0F, 1.0F, 0.0F, 20, 21, 90, 0, 1.0F};
  cloud.add_slice(3, std::vector{a});
  cloud.add_slice(5, std::vector{b});
  SegmentIds ids;
  const std::vector<PointIndex> components{0, 0};
  const IdUpdate update =
      ids.update(cloud, cloud.take_change(), components, std::vector<PointIndex>{0, 1});
  SegmentStatisticsTable table(0.1F);
  EXPECT_EQ(table.apply(cloud, ids, update.changes), std::vector<std::uint32_t>{1});

  const SegmentStatistics s = table(1);
  EXPECT_EQ(s.segment_id, 1U);
  EXPECT_EQ(s.num_points, 2U);
  EXPECT_EQ(s.box_min_W[0], 0.5F);
  EXPECT_EQ(s.box_max_W[1], -1.0F);
  EXPECT_EQ(s.box_min_W[1], -3.0F);
  EXPECT_EQ(s.centroid_W[0], 1.0F);
  EXPECT_EQ(s.centroid_W[1], -2.0F);
  EXPECT_FLOAT_EQ(s.mean_normal_W[0], std::sqrt(0.5F));
  EXPECT_FLOAT_EQ(s.mean_normal_W[1], std::sqrt(0.5F));
  EXPECT_EQ(s.mean_color[0], 15);
  EXPECT_EQ(s.mean_color[1], 21);  // 20.5, rounded away from zero
  EXPECT_EQ(s.mean_color[2], 60);
  EXPECT_FLOAT_EQ(s.area_m2, 0.02F);
  EXPECT_EQ(s.first_slice, 3);
  EXPECT_EQ(s.last_slice, 5);
}

TEST(SegmentStatistics, GiveNoMeanNormalWhereTheNormalsCancelOut) {
  PointCloud cloud;
  CloudPoint up{0, 0, 0, 0, 0, 1.0F};
  CloudPoint down{0, 0, 0, 0, 0, -1.0F};
  cloud.add_slice(0, std::vector{up, down});
  SegmentIds ids;
  const std::vector<PointIndex> components{0, 0};
  SegmentStatisticsTable table(0.1F);
  const IdUpdate update =
      ids.update(cloud, cloud.take_change(), components, std::vector<PointIndex>{0, 1});
  table.apply(cloud, ids, update.changes);
  EXPECT_EQ(table(1).mean_normal_W[2], 0.0F);
}

}  // namespace
}  // namespace kintsugi::segmenter
