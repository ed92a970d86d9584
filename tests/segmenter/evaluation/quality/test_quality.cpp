// What a segmentation is scored: which instances count, and how segments are counted.

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "segmenter/evaluation/quality/quality.hpp"
#include "tests/segmenter/core/random_clouds.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr double kRounding = 1e-12;  // of sums of few numbers

/// A table (1, structure) of 1,000 points, a monitor (2) of 200, a cup (3) of 100, a pen (4) of 20
/// and 30 points of nobody, on a lattice of 1 cm.
class Quality : public ::testing::Test {
 protected:
  Quality() {
    add(1, 1000);
    add(2, 200);
    add(3, 100);
    add(4, 20);
    add(kNoInstance, 30);
    for (int i = 0; i < 1350; ++i) {
      const int row = i / 50;
      points_.push_back(testing::make_point(0.01 * (i % 50), 0.01 * row, 0.0, 0.0, 0.0, 1.0));
    }
  }

  void add(std::uint32_t instance, std::size_t count) {
    instances_.insert(instances_.end(), count, instance);
  }

  SegmentationQuality assess(const std::vector<std::uint32_t>& segments,
                             const QualityConfig& config = {}) const {
    return assess_quality(points_, instances_, segments, {2, 3, 4}, config);
  }

  std::vector<CloudPoint> points_;
  std::vector<std::uint32_t> instances_;
};

TEST_F(Quality, OfTheTruthIsPerfect) {
  const auto quality = assess(instances_);
  EXPECT_EQ(quality.num_points, 1320);
  EXPECT_EQ(quality.num_instances, 3);  // the pen is too small
  EXPECT_EQ(quality.num_objects, 2);
  EXPECT_EQ(quality.num_objects_found, 2);
  EXPECT_EQ(quality.object_iou, 1.0);
  EXPECT_EQ(quality.instance_iou, 1.0);
  EXPECT_EQ(quality.achievable_accuracy, 1.0);
  EXPECT_EQ(quality.undersegmentation_error, 0.0);
  EXPECT_EQ(quality.boundary.recall, 1.0);
  EXPECT_EQ(quality.boundary.precision, 1.0);
  EXPECT_EQ(quality.num_segments, 4);  // the label of nobody is no segment
  EXPECT_NEAR(quality.large_segment_share, 1300.0 / 1350.0, kRounding);
}

TEST_F(Quality, CountsObjectsAndStructureApart) {
  auto segments = instances_;
  for (std::size_t i = 0; i < 250; ++i) segments[i] = 100;             // a quarter of the table
  for (std::size_t i = 1000; i < 1120; ++i) segments[i] = 101;         // 120 of 200 of the monitor
  for (std::size_t i = 1200; i < 1251; ++i) segments[i] = kNoSegment;  // 51 of 100 of the cup
  const auto quality = assess(segments);
  EXPECT_NEAR(quality.object_iou, (0.6 + 0.49) / 2.0, kRounding);
  EXPECT_NEAR(quality.instance_iou, (0.75 + 0.6 + 0.49) / 3.0, kRounding);
  EXPECT_EQ(quality.num_objects_found, 1);
  EXPECT_EQ(quality.num_segments, 6);
  EXPECT_EQ(quality.instances.size(), 4U);
}

TEST_F(Quality, CountsSmallInstancesWhenAsked) {
  QualityConfig config;
  config.min_instance_points = 1;
  config.large_segment_points = 20;
  config.found_iou = 1.0;
  const auto quality = assess(instances_, config);
  EXPECT_EQ(quality.num_objects_found, 3);
  EXPECT_NEAR(quality.large_segment_share, 1320.0 / 1350.0, kRounding);
}

TEST_F(Quality, NamesWhatIsWrongInAConfig) {
  QualityConfig config;
  config.min_instance_points = 0;
  EXPECT_THAT([&] { assess(instances_, config); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("min_instance_points is 0")));
  config = {};
  config.found_iou = 1.5;
  EXPECT_THAT([&] { assess(instances_, config); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("found_iou is 1.5")));
  config = {};
  config.large_segment_points = 0;
  EXPECT_THAT([&] { assess(instances_, config); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("large_segment_points is 0")));
  config = {};
  config.boundary.tolerance_m = -1.0;
  EXPECT_THAT([&] { assess(instances_, config); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("tolerance_m is -1")));
}

}  // namespace
}  // namespace kintsugi::segmenter
