// Clouds whose truth is known: what their header says, and which point has which instance.

#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "segmenter/core/graph/neighbour_index.hpp"
#include "segmenter/evaluation/quality/ground_truth.hpp"
#include "segmenter/evaluation/quality/overlap.hpp"
#include "tests/segmenter/core/random_clouds.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// Vertices x of y = z = 0 and their instances, under these comment lines.
Truth truth_of(const std::string& comments,
               const std::vector<std::pair<std::string, int>>& vertices) {
  std::string bytes = "ply\nformat ascii 1.0\n" + comments + "element vertex " +
                      std::to_string(vertices.size()) +
                      "\nproperty float x\nproperty float y\nproperty float z\n"
                      "property uint instance_id\nend_header\n";
  for (const auto& [x, instance] : vertices) {
    bytes += x + " 0 0 " + std::to_string(instance) + "\n";
  }
  return make_truth(parse_ply(bytes, "truth.ply"), "truth.ply");
}

auto fails_with(const std::string& what) {
  return ThrowsMessage<std::runtime_error>(AllOf(HasSubstr("truth.ply"), HasSubstr(what)));
}

TEST(QualityTruth, KnowsWhatTheHeaderSaysOfItsInstances) {
  const Truth truth = truth_of(
      "comment instance 7 structure north wall\ncomment made by a test\n"
      "comment instance 9 object  a cup, blue \ncomment instance 3 object unseen\n",
      {{"0", 9}, {"1", 7}, {"2", 0}, {"3", 9}});
  ASSERT_EQ(truth.instances.size(), 2U);
  EXPECT_EQ(truth.instances[0].id, 7U);
  EXPECT_EQ(truth.instances[0].name, "north wall");
  EXPECT_FALSE(truth.instances[0].is_object);
  EXPECT_EQ(truth.instances[1].name, "a cup, blue");
  EXPECT_THAT(truth.objects(), ElementsAre(9));
  EXPECT_THAT(truth.instance_ids, ElementsAre(9, 7, 0, 9));
}

TEST(QualityTruth, WithoutLinesEveryInstanceIsAnObject) {
  const Truth truth = truth_of("comment instance segmentation of a scan\n", {{"0", 2}, {"1", 5}});
  EXPECT_THAT(truth.objects(), ElementsAre(2, 5));
}

TEST(QualityTruth, LeavesOutPointsThatAreNowhere) {
  const Truth truth = truth_of("", {{"0", 2}, {"nan", 5}, {"inf", 6}});
  EXPECT_EQ(truth.points_W.size(), 1U);
  EXPECT_THAT(truth.objects(), ElementsAre(2));
}

TEST(QualityTruth, NamesWhatIsWrong) {
  const std::string wall = "comment instance 1 structure wall\n";
  EXPECT_THAT(
      [&] {
        truth_of(wall + wall, {{"0", 1}});
      },
      fails_with("instance 1 is described a second"));
  EXPECT_THAT(
      [&] {
        truth_of(wall, {{"0", 1}, {"1", 4}});
      },
      fails_with("no line 'comment instance 4"));
  EXPECT_THAT([&] { truth_of("", {}); }, fails_with("holds no points"));
  EXPECT_THAT([&] { truth_of("", {{"nan", 1}}); }, fails_with("holds no points"));
  PlyCloud unlabelled;
  unlabelled.points_W.resize(1);
  EXPECT_THAT([&] { make_truth(unlabelled, "truth.ply"); },
              fails_with("lacks property 'instance_id'"));
}

TEST(QualityTruth, TellsTheInstanceOfTheNearestPointWithinReach) {
  const Truth truth = truth_of("", {{"0", 1}, {"1", 2}, {"2", 0}});
  std::vector<CloudPoint> points(5);
  points[0].x = 0.4F;
  points[1].x = 0.625F;
  points[2].x = 1.9F;   // near a point that nothing is known of
  points[3].x = -0.5F;  // just within reach
  points[4].x = -0.51F;
  EXPECT_THAT(instances_at(points, truth, 0.5), ElementsAre(1, 2, kNoInstance, 1, kNoInstance));
  EXPECT_THAT(instances_at({}, truth, 0.5), ElementsAre());
}

TEST(QualityTruth, TellsWhatEveryPointSays) {
  Truth truth;
  truth.points_W = testing::random_cloud(testing::CloudShape::kUnrelated, 500, 1);
  for (std::uint32_t i = 0; i < 500; ++i) truth.instance_ids.push_back(i + 1);
  const auto points = testing::random_cloud(testing::CloudShape::kUnrelated, 300, 2);
  constexpr float kReach_m = 0.008F;
  const auto instances = instances_at(points, truth, kReach_m);
  int num_out_of_reach = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::uint32_t nearest = kNoInstance;
    float least_m2 = kReach_m * kReach_m;
    for (std::size_t k = 0; k < 500; ++k) {
      const float distance_m2 = squared_distance(points[i], truth.points_W[k]);
      if (distance_m2 > least_m2) continue;
      least_m2 = distance_m2;
      nearest = truth.instance_ids[k];
    }
    EXPECT_EQ(instances[i], nearest);
    num_out_of_reach += nearest == kNoInstance ? 1 : 0;
  }
  EXPECT_GT(num_out_of_reach, 10);
  EXPECT_LT(num_out_of_reach, 250);
}

}  // namespace
}  // namespace kintsugi::segmenter
