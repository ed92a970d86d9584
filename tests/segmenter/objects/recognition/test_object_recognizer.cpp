#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "segmenter/objects/model/make_model.hpp"
#include "segmenter/objects/recognition/model_index.hpp"
#include "segmenter/objects/recognition/object_recognizer.hpp"
#include "segmenter/objects/recognition/scene_light.hpp"
#include "tests/segmenter/objects/box_on_table.hpp"

namespace kintsugi::segmenter {
namespace {

using testing::box_on_table;
using testing::kBall;
using testing::kBox;
using testing::MapOfThings;

const Eigen::Vector3d kUp_W = -Eigen::Vector3d::UnitY();

std::vector<CloudPoint> points_of(const ObservedMap& map, std::uint32_t id) {
  std::vector<CloudPoint> points_W;
  for (std::size_t i = 0; i < map.points_W.size(); ++i) {
    if (map.segment_ids[i] == id) points_W.push_back(map.points_W[i]);
  }
  return points_W;
}

MadeModel taught(const ObservedMap& map, std::uint32_t id, const std::string& name) {
  return make_model(name, points_of(map, id), map.resolution_m, kUp_W);
}

MapAccess access_to(const ObservedMap& map) {
  MapAccess access;
  access.resolution_m = map.resolution_m;
  access.up_W = kUp_W;
  access.points_in = [&map](const Eigen::AlignedBox3f& box_W) {
    MapExcerpt excerpt;
    for (std::size_t i = 0; i < map.points_W.size(); ++i) {
      const CloudPoint& p = map.points_W[i];
      if (!box_W.contains(Eigen::Vector3f(p.x, p.y, p.z))) continue;
      excerpt.points_W.push_back(p);
      excerpt.segment_ids.push_back(map.segment_ids[i]);
    }
    return excerpt;
  };
  access.points_of = [&map](const std::vector<std::uint32_t>& ids) {
    std::vector<CloudPoint> all;
    for (const std::uint32_t id : ids) {
      const std::vector<CloudPoint> of = points_of(map, id);
      all.insert(all.end(), of.begin(), of.end());
    }
    return all;
  };
  access.num_points = [&map](std::uint32_t id) {
    return std::count(map.segment_ids.begin(), map.segment_ids.end(), id);
  };
  return access;
}

struct PoseError {
  double shift_m;
  double turn_rad;
};

PoseError error_of(const Pose& X, const Pose& X_true) {
  const Pose difference = X.inverse() * X_true;
  return {difference.translation().norm(), Eigen::AngleAxisd(difference.linear()).angle()};
}

/// The motion of a box in W that is moved on the table.
Pose motion_W(const Eigen::Vector3d& shift_U, double turn_rad) {
  Pose motion_U = Pose::Identity();
  motion_U.linear() = Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  motion_U.translation() = shift_U;
  const Pose X_WU = MapOfThings::X_WU();
  return X_WU * motion_U * X_WU.inverse();
}

const std::vector<std::string> kFourSides = {"z", "-y", "x", "-x"};

TEST(RefinedPose, ComesBackFromTwoVoxels) {
  const ObservedMap map = box_on_table(kFourSides);
  const MadeModel box = taught(map, kBox, "box");
  const PreparedModel model(box.model, map.resolution_m);
  Pose X_WO = box.X_WO;
  X_WO.translation() += Eigen::Vector3d(0.012, -0.01, 0.014);
  X_WO.rotate(Eigen::AngleAxisd(0.08, Eigen::Vector3d(1, 2, 3).normalized()));
  const PoseHypothesis refined =
      refined_pose(model, thinned(points_of(map, kBox), map.resolution_m), X_WO);
  const PoseError error = error_of(refined.X_WO, box.X_WO);
  EXPECT_LT(error.shift_m, 0.002);
  EXPECT_LT(error.turn_rad, 0.02);
  EXPECT_GT(refined.agreement, 0.95F);
}

class TurnedBox : public ::testing::TestWithParam<double> {};

TEST_P(TurnedBox, IsRecognisedAndPlaced) {
  const ObservedMap before = box_on_table(kFourSides);
  const MadeModel box = taught(before, kBox, "box");
  const ObservedMap after =
      box_on_table(kFourSides, {-0.25F, 0.1F, 0.0F}, static_cast<float>(GetParam()));
  const ObjectRecognizer recognizer({box.model}, after.resolution_m);
  const auto found = recognizer.recognize(points_of(after, kBox), access_to(after));
  ASSERT_TRUE(found.has_value());
  const PoseError error =
      error_of(found->placement.X_WO, motion_W({-0.25, 0.1, 0.0}, GetParam()) * box.X_WO);
  EXPECT_LT(error.shift_m, 0.005);
  EXPECT_LT(error.turn_rad, 0.03);
  // At the edges, which have a tenth of the points, the colours of two faces mix.
  EXPECT_GT(found->placement.score(), 0.75F);
  EXPECT_THAT(found->placement.segment_ids, ::testing::ElementsAre(kBox));
}

INSTANTIATE_TEST_SUITE_P(Turns, TurnedBox, ::testing::Values(0.0, 0.4, 1.6, 3.1, -2.0));

TEST(ObjectRecognizer, TellsOneObjectFromAnother) {
  const ObservedMap map = box_on_table(kFourSides);
  const ObjectRecognizer recognizer(
      {taught(map, kBall, "ball").model, taught(map, kBox, "box").model}, map.resolution_m);
  EXPECT_EQ(recognizer.recognize(points_of(map, kBall), access_to(map))->model, 0U);
  EXPECT_EQ(recognizer.recognize(points_of(map, kBox), access_to(map))->model, 1U);
}

TEST(ObjectRecognizer, DoesNotTakeABoxOfAnotherSizeForTheOneItKnows) {
  const ObservedMap known = box_on_table(kFourSides);
  const ObservedMap other =
      box_on_table(kFourSides, Eigen::Vector3f::Zero(), 0.0F, {0.12F, 0.16F, 0.24F});
  const ObjectRecognizer recognizer({taught(known, kBox, "box").model}, known.resolution_m);
  EXPECT_FALSE(recognizer.recognize(points_of(other, kBox), access_to(other)).has_value());
}

TEST(ObjectRecognizer, DoesNotTakeAnotherColourForTheOneItKnows) {
  ObservedMap map = box_on_table(kFourSides);
  const ObjectRecognizer recognizer({taught(map, kBox, "box").model}, map.resolution_m);
  for (CloudPoint& p : map.points_W) std::swap(p.red, p.blue);
  EXPECT_FALSE(recognizer.recognize(points_of(map, kBox), access_to(map)).has_value());
}

TEST(ObjectRecognizer, RecognisesAnObjectInOtherLight) {
  ObservedMap map = box_on_table(kFourSides);
  const ObjectRecognizer recognizer({taught(map, kBox, "box").model}, map.resolution_m);
  for (CloudPoint& p : map.points_W) {
    p.red = static_cast<std::uint8_t>(0.9 * p.red);
    p.green = static_cast<std::uint8_t>(0.8 * p.green);
    p.blue = static_cast<std::uint8_t>(0.66 * p.blue);
  }
  const auto found = recognizer.recognize(points_of(map, kBox), access_to(map));
  ASSERT_TRUE(found.has_value());
  // The exponent of sRGB's transfer function is about 2.2.
  EXPECT_NEAR(found->placement.light.log_gain.x(), 2.2 * std::log(0.9), 0.1);
  EXPECT_NEAR(found->placement.light.log_gain.y(), 2.2 * std::log(0.8), 0.1);
  // Its blues are dark, where the transfer function is flatter.
  EXPECT_NEAR(found->placement.light.log_gain.z(), 2.2 * std::log(0.66), 0.35);
}

TEST(ObjectRecognizer, FindsNothingWithoutObjectsOrSurface) {
  const ObservedMap map = box_on_table();
  const ObjectRecognizer none({}, map.resolution_m);
  EXPECT_FALSE(none.recognize(points_of(map, kBox), access_to(map)).has_value());
  const ObjectRecognizer some({taught(map, kBox, "box").model}, map.resolution_m);
  EXPECT_FALSE(some.recognize({}, access_to(map)).has_value());
}

TEST(Placement, CountsWhatSpeaksAgainstTheObject) {
  const ObservedMap map = box_on_table(kFourSides);
  const MadeModel box = taught(map, kBox, "box");
  const PreparedModel model(box.model, map.resolution_m);
  const Placement right = placement_of(model, access_to(map), {.X_WO = box.X_WO, .light = {}});
  EXPECT_GT(right.score(), 0.75F);
  EXPECT_GT(right.points, 0.85 * static_cast<double>(points_of(map, kBox).size()));
  EXPECT_LE(right.points, static_cast<std::int32_t>(points_of(map, kBox).size()));

  ObservedMap halved = map;  // half of the box is gone
  for (std::size_t i = halved.points_W.size(); i-- > 0;) {
    const bool is_left = halved.points_W[i].x < MapOfThings::X_WU().translation().x();
    if (halved.segment_ids[i] != kBox || !is_left) continue;
    halved.points_W.erase(halved.points_W.begin() + static_cast<std::ptrdiff_t>(i));
    halved.segment_ids.erase(halved.segment_ids.begin() + static_cast<std::ptrdiff_t>(i));
  }
  const Placement half = placement_of(model, access_to(halved), {.X_WO = box.X_WO, .light = {}});
  EXPECT_LT(half.seen, 0.7F);
  EXPECT_GT(half.contradicted, 0.1F);
  EXPECT_LT(half.score(), right.score() - 0.05F);
}

TEST(ModelIndex, FindsTheObjectOfTheNearestViewAndBoundsItFromBelow) {
  std::vector<IndexedView> views;
  for (std::size_t model = 0; model < 30; ++model) {
    for (int view = 0; view < 5; ++view) {
      ViewDescriptor descriptor;
      for (int k = 0; k < kViewDescriptorSize; ++k) {
        descriptor[k] =
            std::sin(1.0F + 7.0F * static_cast<float>(model) + 3.0F * static_cast<float>(k)) +
            0.05F * std::cos(static_cast<float>(view + k));
      }
      views.push_back({model, descriptor});
    }
  }
  const ModelIndex index(views);
  for (std::size_t i = 0; i < views.size(); i += 7) {
    const std::vector<ModelMatch> matches = index.nearest(views[i].descriptor, 3);
    ASSERT_EQ(matches.size(), 3U);
    EXPECT_EQ(matches[0].model, views[i].model);
    EXPECT_NEAR(matches[0].distance, 0.0F, 1e-3F);
    EXPECT_LE(matches[1].distance, matches[2].distance);
    const SizeAndColors beginning = views[i].descriptor.head<kSizeAndColors>();
    EXPECT_TRUE(index.has_near(beginning, matches[0].distance + 1e-3F));
  }
  EXPECT_FALSE(index.has_near(SizeAndColors::Constant(1e3F), 1.0F));
  EXPECT_TRUE(ModelIndex({}).nearest(ViewDescriptor::Zero(), 3).empty());
}

TEST(SceneLight, IsThatOfMostPlacements) {
  const auto with_light = [](const Eigen::Vector3f& log_gain) {
    Placement placement;
    placement.seen = placement.explained = 1.0F;
    placement.light.log_gain = log_gain;
    return placement;
  };
  const std::vector<Placement> placements = {
      with_light({-0.2F, -0.4F, -0.8F}), with_light({0.5F, 0.5F, 0.5F}),
      with_light({-0.25F, -0.45F, -0.8F}), with_light({-0.2F, -0.4F, -0.75F})};
  std::vector<const Placement*> all;
  for (const Placement& placement : placements) all.push_back(&placement);
  const SceneLight light = light_of_scene(all);
  EXPECT_LT((light.log_gain - Eigen::Vector3f(-0.22F, -0.42F, -0.78F)).norm(), 0.05F);
  EXPECT_GT(light.agreement(placements[0].light), 0.95F);
  EXPECT_LT(light.agreement(placements[1].light), 0.01F);
  EXPECT_EQ(light_of_scene(std::span(all).first(2)).log_gain, Eigen::Vector3f::Zero());
}

}  // namespace
}  // namespace kintsugi::segmenter
