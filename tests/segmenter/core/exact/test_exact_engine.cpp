// What ExactEngine decides itself: when to build its state anew.

#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "segmenter/core/engine/engine.hpp"
#include "segmenter/core/make_engine.hpp"
#include "tests/segmenter/core/random_clouds.hpp"

namespace kintsugi::segmenter {
namespace {

/// Mode exact, and batch beside it.
class ExactEngineTest : public ::testing::Test {
 protected:
  void use(const EngineConfig& config) {
    exact_ = make_engine("exact", cloud_, config);
    batch_ = make_engine("batch", cloud_, config);
  }

  RunStatistics update() {
    const CloudChange change = cloud_.take_change();
    const RunStatistics statistics = exact_->update(change);
    batch_->update(change);
    const auto labels = canonical_labels(exact_->components());
    EXPECT_TRUE(labels == canonical_labels(batch_->components()));
    for (PointIndex x = 0; x < labels.size(); ++x) {
      if (labels[x] != x) continue;  // one point of each segment
      EXPECT_EQ(exact_->theta(exact_->components()[x]), batch_->theta(batch_->components()[x]));
    }
    return statistics;
  }

  PointCloud cloud_;
  std::unique_ptr<SegmentationEngine> exact_;
  std::unique_ptr<SegmentationEngine> batch_;
};

TEST_F(ExactEngineTest, BuildsAnewWhereMuchChanges) {
  EngineConfig config;
  config.rebuild_share = 0.4;
  use(config);
  constexpr int kNumPoints = 300;
  for (std::int32_t slice_id = 0; slice_id < 4; ++slice_id) {
    const auto seed = static_cast<unsigned>(slice_id);
    cloud_.add_slice(slice_id,
                     testing::random_cloud(testing::CloudShape::kWaves, kNumPoints, seed));
    EXPECT_EQ(update().is_rebuilt, slice_id < 3);  // 300 are 1/3 of 900
  }
  cloud_.replace_slice(1, {});
  EXPECT_FALSE(update().is_rebuilt);  // 1/4 of 1200
  cloud_.replace_slice(2, {});
  EXPECT_FALSE(update().is_rebuilt);  // 1/3 of 900
  cloud_.replace_slice(3, {});
  const RunStatistics statistics = update();
  EXPECT_TRUE(statistics.is_rebuilt);  // 1/2 of 600
  EXPECT_EQ(statistics.num_points, kNumPoints);
}

/// A flat square of `side` by `side` points, 1 cm apart, from (x_m, 0) on.
std::vector<CloudPoint> plate(double x_m, int side) {
  std::vector<CloudPoint> points_W;
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      points_W.push_back(testing::make_point(x_m + 0.01 * column, 0.01 * row, 0.0, 0.0, 0.0, 1.0));
    }
  }
  return points_W;
}

TEST_F(ExactEngineTest, GivesUpWhereACorrectionReachesFarAndGoesOn) {
  // Two plates of 22,500 points and a bent bridge of one point, which leaves: more points than the
  // 20,000 that are always explored would have to be looked at again.
  EngineConfig config;
  config.scale = 1.0;  // so that plates are alive at the weight of the bridge, 2e-5
  config.rebuild_share = 1e9;
  config.explore_share = 0.0;
  use(config);
  constexpr int kSide = 150;
  const double width_m = 0.01 * kSide;
  cloud_.add_slice(0, plate(0.0, kSide));
  cloud_.add_slice(1, plate(width_m + 0.02, kSide));
  update();
  const std::vector<CloudPoint> bridge = {
      testing::make_point(width_m + 0.005, 0.0, 0.0, 0.006, 0.0, 1.0)};
  cloud_.add_slice(2, bridge);
  EXPECT_FALSE(update().is_rebuilt);
  ASSERT_EQ(exact_->components().front(), exact_->components()[2 * kSide * kSide - 1]);
  cloud_.replace_slice(2, {});
  EXPECT_TRUE(update().is_rebuilt);
  ASSERT_NE(exact_->components().front(), exact_->components()[2 * kSide * kSide - 1]);
  // Nothing of the run that was given up is left.
  cloud_.add_slice(3, bridge);
  EXPECT_FALSE(update().is_rebuilt);
  cloud_.replace_slice(3, {});
  update();
}

}  // namespace
}  // namespace kintsugi::segmenter
