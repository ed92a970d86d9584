#include <random>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>

#include "segmenter/core/point_cloud.hpp"
#include "tests/segmenter/random_clouds.hpp"

namespace kintsugi::segmenter {
namespace {

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
  EXPECT_THAT(record.rejected, ::testing::ElementsAre(0, 2, 3));
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

}  // namespace
}  // namespace kintsugi::segmenter
