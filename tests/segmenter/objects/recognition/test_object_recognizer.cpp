#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "segmenter/objects/model/make_model.hpp"
#include "segmenter/objects/recognition/model_index.hpp"
#include "segmenter/objects/recognition/object_recognizer.hpp"
#include "segmenter/objects/recognition/scene.hpp"
#include "segmenter/objects/recognition/scene_light.hpp"
#include "segmenter/objects/recognition/surface_grid.hpp"
#include "tests/segmenter/objects/box_on_table.hpp"

namespace kintsugi::segmenter {
namespace {

using testing::box_on_table;
using testing::kBall;
using testing::kBox;
using testing::kBoxSize_m;
using testing::kTable;
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

/// The whole map as one piece.
struct SceneOf {
  explicit SceneOf(const ObservedMap& map) : scene(map.resolution_m) {
    scene.set_piece(0, std::make_shared<const std::vector<CloudPoint>>(map.points_W),
                    map.segment_ids);
  }
  Scene scene;
};

std::vector<Recognition> recognized(const ObjectRecognizer& recognizer, const ObservedMap& map,
                                    const Candidate& candidate) {
  return recognizer.recognize(candidate, SceneOf(map).scene);
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
  const std::vector<Recognition> found = recognized(recognizer, after, {kBox});
  ASSERT_EQ(found.size(), 1U);
  const PoseError error =
      error_of(found[0].placement.X_WO, motion_W({-0.25, 0.1, 0.0}, GetParam()) * box.X_WO);
  EXPECT_LT(error.shift_m, 0.005);
  EXPECT_LT(error.turn_rad, 0.03);
  // At the edges, which have a tenth of the points, the colours of two faces mix.
  EXPECT_GT(found[0].placement.score(), 0.75F);
  EXPECT_THAT(found[0].placement.segment_ids, ::testing::ElementsAre(kBox));
}

INSTANTIATE_TEST_SUITE_P(Turns, TurnedBox, ::testing::Values(0.0, 0.4, 1.6, 3.1, -2.0));

TEST(ObjectRecognizer, TellsOneObjectFromAnother) {
  const ObservedMap map = box_on_table(kFourSides);
  const ObjectRecognizer recognizer(
      {taught(map, kBall, "ball").model, taught(map, kBox, "box").model}, map.resolution_m);
  EXPECT_EQ(recognized(recognizer, map, {kBall}).at(0).model, 0U);
  EXPECT_EQ(recognized(recognizer, map, {kBox}).at(0).model, 1U);
}

TEST(ObjectRecognizer, DoesNotTakeABoxOfAnotherSizeForTheOneItKnows) {
  const ObservedMap known = box_on_table(kFourSides);
  const ObservedMap other =
      box_on_table(kFourSides, Eigen::Vector3f::Zero(), 0.0F, {0.12F, 0.16F, 0.24F});
  const ObjectRecognizer recognizer({taught(known, kBox, "box").model}, known.resolution_m);
  EXPECT_THAT(recognized(recognizer, other, {kBox}), ::testing::IsEmpty());
}

TEST(ObjectRecognizer, DoesNotTakeAnotherColourForTheOneItKnows) {
  ObservedMap map = box_on_table(kFourSides);
  const ObjectRecognizer recognizer({taught(map, kBox, "box").model}, map.resolution_m);
  for (CloudPoint& p : map.points_W) std::swap(p.red, p.blue);
  EXPECT_THAT(recognized(recognizer, map, {kBox}), ::testing::IsEmpty());
}

TEST(ObjectRecognizer, RecognisesAnObjectInOtherLight) {
  ObservedMap map = box_on_table(kFourSides);
  const ObjectRecognizer recognizer({taught(map, kBox, "box").model}, map.resolution_m);
  for (CloudPoint& p : map.points_W) {
    p.red = static_cast<std::uint8_t>(0.9 * p.red);
    p.green = static_cast<std::uint8_t>(0.8 * p.green);
    p.blue = static_cast<std::uint8_t>(0.66 * p.blue);
  }
  const std::vector<Recognition> found = recognized(recognizer, map, {kBox});
  ASSERT_EQ(found.size(), 1U);
  // The exponent of sRGB's transfer function is about 2.2.
  EXPECT_NEAR(found[0].placement.light.log_gain.x(), 2.2 * std::log(0.9), 0.1);
  EXPECT_NEAR(found[0].placement.light.log_gain.y(), 2.2 * std::log(0.8), 0.1);
  // Its blues are dark, where the transfer function is flatter.
  EXPECT_NEAR(found[0].placement.light.log_gain.z(), 2.2 * std::log(0.66), 0.35);
}

TEST(ObjectRecognizer, DoesNotKnowAFlatPatchOfOneColour) {
  const Eigen::Vector3f corner(0.0F, 0.0F, 0.1F);
  const Eigen::Vector3f x(0.2F, 0.0F, 0.0F);
  const Eigen::Vector3f half_y(0.0F, 0.1F, 0.0F);
  const Eigen::Vector3i tan(200, 170, 120);
  const auto board_with = [&](const Eigen::Vector3i& other_half, float rim_m) {
    MapOfThings things;
    things.add_face(corner, x, half_y, tan, kBox);
    things.add_face(corner + half_y, x, half_y, other_half, kBox);
    if (rim_m > 0.0F) things.add_face(corner, -rim_m * Eigen::Vector3f::UnitZ(), x, tan, kBox);
    return things.take();
  };
  const auto is_known = [](const ObservedMap& map) {
    const ObjectRecognizer recognizer({taught(map, kBox, "board").model}, map.resolution_m);
    return !recognized(recognizer, map, {kBox}).empty();
  };
  EXPECT_FALSE(is_known(board_with(tan, 0.0F)));
  EXPECT_TRUE(is_known(board_with({60, 80, 160}, 0.0F)));
  EXPECT_TRUE(is_known(board_with(tan, 0.04F)));
}

TEST(ObjectRecognizer, DoesNotKnowAFlatPatchByItsRim) {
  // Where the faces of a box meet, normals are between theirs.
  const Eigen::Vector3i tan(200, 170, 120);
  const Eigen::Vector3f corner(0.0F, 0.0F, 0.1F);
  const Eigen::Vector3f x(0.2F, 0.0F, 0.0F);
  const Eigen::Vector3f y(0.0F, 0.2F, 0.0F);
  const Eigen::Vector3f up(0.0F, 0.007F, 0.007F);
  const Eigen::Vector3f down(0.0F, 0.007F, -0.007F);
  MapOfThings things;
  things.add_face(corner - up, x, up, tan, kBox);
  things.add_face(corner, x, y, tan, kBox);
  things.add_face(corner + y, x, down, tan, kBox);
  const ObservedMap map = things.take();
  const ObjectRecognizer recognizer({taught(map, kBox, "lid").model}, map.resolution_m);
  EXPECT_THAT(recognized(recognizer, map, {kBox}), ::testing::IsEmpty());
}

TEST(ObjectRecognizer, KnowsAFlatThingByColoursThatAreOtherSegments) {
  const auto keyboard_with_keys_in = [](std::uint32_t segment) {
    MapOfThings things;
    const Eigen::Vector3f corner(0.0F, 0.0F, 0.1F);
    const Eigen::Vector3f x(0.3F, 0.0F, 0.0F);
    const Eigen::Vector3f y(0.0F, 0.1F, 0.0F);
    things.add_face(corner, x, y, {40, 40, 45}, kBox);
    things.add_face(corner + 1.2F * y, x, 0.5F * y, {190, 190, 190}, segment);
    things.add_face({-0.6F, -0.5F, 0.0F}, {1.2F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}, {150, 140, 130},
                    kTable);
    return things.take();
  };
  const ObservedMap whole = keyboard_with_keys_in(kBox);
  const ObjectRecognizer recognizer({taught(whole, kBox, "keyboard").model}, whole.resolution_m);
  const ObservedMap divided = keyboard_with_keys_in(kTable);
  const std::vector<Recognition> found = recognized(recognizer, divided, {kBox});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_THAT(found[0].placement.segment_ids, ::testing::ElementsAre(kBox));
}

TEST(ObjectRecognizer, FindsNothingWithoutObjectsOrSurface) {
  const ObservedMap map = box_on_table();
  const ObjectRecognizer none({}, map.resolution_m);
  EXPECT_THAT(recognized(none, map, {kBox}), ::testing::IsEmpty());
  const ObjectRecognizer some({taught(map, kBox, "box").model}, map.resolution_m);
  EXPECT_THAT(recognized(some, map, {}), ::testing::IsEmpty());
  constexpr std::uint32_t kNoSuchSegment = 4711;
  EXPECT_THAT(recognized(some, map, {kNoSuchSegment}), ::testing::IsEmpty());
}

TEST(ObjectRecognizer, PreparesOnlyWhatHasChanged) {
  const ObservedMap map = box_on_table(kFourSides);
  const ObjectModel ball = taught(map, kBall, "ball").model;
  const ObjectModel box = taught(map, kBox, "box").model;
  ObjectModel half_a_box = box;
  half_a_box.points_O.resize(box.points_O.size() / 2);
  const ObjectRecognizer first({ball, half_a_box}, map.resolution_m);
  EXPECT_EQ(first.num_prepared(), 2U);
  const ObjectRecognizer again({box, ball}, map.resolution_m, &first);
  EXPECT_EQ(again.num_prepared(), 1U);
  EXPECT_EQ(again.model(1).name, "ball");
  const ObjectRecognizer anew({box, ball}, map.resolution_m);
  for (const std::uint32_t id : {kBox, kBall}) {
    const auto expected = recognized(anew, map, {id});
    const auto found = recognized(again, map, {id});
    ASSERT_EQ(expected.size(), 1U);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].model, expected[0].model);
    EXPECT_EQ(found[0].placement.X_WO.matrix(), expected[0].placement.X_WO.matrix());
  }
  const ObjectRecognizer coarser({box, ball}, 2 * map.resolution_m, &again);
  EXPECT_EQ(coarser.num_prepared(), 2U);
}

TEST(Placement, CountsWhatSpeaksAgainstTheObject) {
  const ObservedMap map = box_on_table(kFourSides);
  const MadeModel box = taught(map, kBox, "box");
  const PreparedModel model(box.model, map.resolution_m);
  const Placement right = placement_of(model, SceneOf(map).scene, {.X_WO = box.X_WO, .light = {}});
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
  const Placement half =
      placement_of(model, SceneOf(halved).scene, {.X_WO = box.X_WO, .light = {}});
  EXPECT_LT(half.seen, 0.7F);
  EXPECT_GT(half.contradicted, 0.1F);
  EXPECT_LT(half.score(), right.score() - 0.05F);
}

TEST(Placement, TellsAColourThatIsAnotherOnAverageOnly) {
  // In both cases each point could be the same.
  const auto painted = [](const Eigen::Vector3i& color) {
    ObservedMap map = box_on_table(kFourSides);
    for (std::size_t i = 0; i < map.points_W.size(); ++i) {
      if (map.segment_ids[i] != kBox) continue;
      map.points_W[i].red = static_cast<std::uint8_t>(color[0]);
      map.points_W[i].green = static_cast<std::uint8_t>(color[1]);
      map.points_W[i].blue = static_cast<std::uint8_t>(color[2]);
    }
    return map;
  };
  const ObservedMap white = painted({190, 192, 190});
  const MadeModel box = taught(white, kBox, "box");
  const PreparedModel model(box.model, white.resolution_m);
  const auto placed = [&](const ObservedMap& map) {
    return placement_of(model, SceneOf(map).scene, {.X_WO = box.X_WO, .light = {}});
  };
  const ObjectRecognizer recognizer({box.model}, white.resolution_m);
  const Placement nearly_white = placed(painted({184, 192, 186}));
  EXPECT_NEAR(nearly_white.color_difference, 3.2F, 0.1F);
  EXPECT_TRUE(recognizer.is_recognized(nearly_white));
  const Placement greenish = placed(painted({164, 196, 180}));
  EXPECT_NEAR(greenish.color_difference, 13.4F, 0.1F);
  EXPECT_GT(greenish.score(), 0.9F);
  EXPECT_FALSE(recognizer.is_recognized(greenish));
}

// It is missing from the object's surface: that once, and not from the segment's share again.
TEST(Placement, CountsSurfaceInAnotherColourOnce) {
  const ObservedMap map = box_on_table(kFourSides);
  const MadeModel box = taught(map, kBox, "box");
  const PreparedModel model(box.model, map.resolution_m);
  ObservedMap repainted = map;
  for (std::size_t i = 0; i < map.points_W.size(); ++i) {
    CloudPoint& p = repainted.points_W[i];
    if (map.segment_ids[i] == kBox && p.red == 200) p.red = 100;  // its lid
  }
  const Placement placement =
      placement_of(model, SceneOf(repainted).scene, {.X_WO = box.X_WO, .light = {}});
  EXPECT_GT(placement.contradicted, 0.2F);
  EXPECT_NEAR(placement.seen + placement.contradicted, 1.0F, 0.05F);
  EXPECT_GT(placement.explained, 0.95F);
  EXPECT_EQ(placement.segment_ids, std::vector<std::uint32_t>{kBox});
}

TEST(Placement, DoubtsAnObjectThatWouldReachIntoAWall) {
  const ObservedMap taught_map = box_on_table(kFourSides);
  const MadeModel box = taught(taught_map, kBox, "box");
  const PreparedModel model(box.model, taught_map.resolution_m);
  // A level camera before the box, above it, which measures one depth everywhere.
  const auto contradicted = [&](double depth_m) {
    MapView view;
    view.intrinsics = {.fx = 130, .fy = 130, .cx = 79.5, .cy = 59.5, .width = 160, .height = 120};
    view.depth_mm.assign(std::size_t{160} * 120, static_cast<std::uint16_t>(1e3 * depth_m));
    ObservedSpace observed(taught_map.resolution_m);
    observed.add(view);
    SceneOf scene(box_on_table({"-y"}));  // the map has its front
    scene.scene.set_observed(&observed);
    return placement_of(model, scene.scene, {.X_WO = box.X_WO, .light = {}}).contradicted;
  };
  const double front_m = MapOfThings::X_WU().translation().z() - kBoxSize_m.y() / 2;
  const float is_free = contradicted(front_m + 1.0);
  const float in_wall = contradicted(front_m);
  const float behind_wall = contradicted(front_m - 0.5);
  // Colours at the edges of its front are those of two sides.
  EXPECT_LT(behind_wall, 0.1F);             // what hides it may have nothing to do with it
  EXPECT_GT(in_wall, behind_wall + 0.1F);   // its top, which faces the camera, by half
  EXPECT_GT(is_free, behind_wall + 0.35F);  // its top, and two more sides
  EXPECT_LT(in_wall - behind_wall, 0.5F * (is_free - behind_wall));
}

TEST(Placement, KnowsNothingOfASideThatWasNotSeenWhenItWasTaught) {
  const ObservedMap map = box_on_table(kFourSides);
  MadeModel box = taught(map, kBox, "box");
  // Taught from one side only.
  const auto is_behind = [](const CloudPoint& p_O) { return p_O.ny > 0.5F || p_O.nx > 0.5F; };
  std::erase_if(box.model.points_O, is_behind);
  const auto explained = [&](const EmptySpace& empty_O) {
    box.model.empty_O = empty_O;
    const PreparedModel model(box.model, map.resolution_m);
    return placement_of(model, SceneOf(map).scene, {.X_WO = box.X_WO, .light = {}}).explained;
  };
  const Eigen::Vector3f low_O(-1.0F, -1.0F, -1.0F);
  const float unknown = explained({});
  const float hidden = explained({low_O, 1.0F, {2, 2, 2}, {1, 0, 0, 0, 0, 0, 0, 0}});
  const float free = explained({low_O, 1.0F, {2, 2, 2}, std::vector<bool>(8, true)});
  EXPECT_FLOAT_EQ(free, unknown);
  EXPECT_LT(free, 0.85F);
  EXPECT_GT(hidden, free + 0.1F);
}

TEST(Scene, SeesTheSameSurfaceInPiecesOfAnyOrder) {
  const ObservedMap map = box_on_table(kFourSides);
  std::array<std::vector<CloudPoint>, 3> points_W;
  std::array<std::vector<std::uint32_t>, 3> labels;
  for (std::size_t i = 0; i < map.points_W.size(); ++i) {
    points_W[i % 3].push_back(map.points_W[i]);
    labels[i % 3].push_back(map.segment_ids[i]);
  }
  const MadeModel box = taught(map, kBox, "box");
  const PreparedModel model(box.model, map.resolution_m);
  const auto placed_in_order = [&](const std::vector<int>& order) {
    Scene scene(map.resolution_m);
    for (const int piece : order) {
      const auto i = static_cast<std::size_t>(piece);
      scene.set_piece(piece, std::make_shared<const std::vector<CloudPoint>>(points_W[i]),
                      labels[i]);
      // What is computed too early is computed again.
      const Placement early = placement_of(model, scene, {.X_WO = box.X_WO, .light = {}});
      EXPECT_LE(early.seen, 1.0F);
    }
    return placement_of(model, scene, {.X_WO = box.X_WO, .light = {}});
  };
  const Placement first = placed_in_order({0, 1, 2});
  const Placement second = placed_in_order({2, 0, 1});
  EXPECT_EQ(first.seen, second.seen);
  EXPECT_EQ(first.explained, second.explained);
  EXPECT_EQ(first.points, second.points);
  EXPECT_GT(first.score(), 0.75F);
}

TEST(Scene, ForgetsWhatHasGone) {
  const ObservedMap map = box_on_table(kFourSides);
  const MadeModel box = taught(map, kBox, "box");
  const PreparedModel model(box.model, map.resolution_m);
  SceneOf whole(map);
  const PoseHypothesis there{.X_WO = box.X_WO, .light = {}};
  EXPECT_GT(placement_of(model, whole.scene, there).points, 0);
  EXPECT_THAT(whole.scene.set_piece(0, std::make_shared<const std::vector<CloudPoint>>(), {}),
              ::testing::Contains(kBox));
  EXPECT_EQ(placement_of(model, whole.scene, there).points, 0);
  EXPECT_THAT(whole.scene.surface_W(Candidate{kBox}), ::testing::IsEmpty());
}

TEST(SurfaceGrid, FindsTheNearestOfManyPoints) {
  Surface surface;
  for (int i = 0; i < 500; ++i) {
    SurfacePoint point;
    point.position = {std::sin(1.3F * static_cast<float>(i)),
                      std::sin(2.1F * static_cast<float>(i)),
                      std::sin(0.7F * static_cast<float>(i))};
    point.normal = i % 2 == 0 ? Eigen::Vector3f::UnitX() : Eigen::Vector3f::UnitY();
    surface.push_back(point);
  }
  const SurfaceGrid grid(surface, 0.1F);
  for (std::size_t i = 0; i < 50; ++i) {
    const Eigen::Vector3f p = 1.2F * surface[7 * i].position;
    constexpr float kWithin_m = 0.3F;
    std::int32_t nearest = -1;
    float least = kWithin_m * kWithin_m;
    for (std::size_t k = 0; k < surface.size(); k += 2) {
      const float squared = (surface[k].position - p).squaredNorm();
      if (squared > least) continue;
      least = squared;
      nearest = static_cast<std::int32_t>(k);
    }
    EXPECT_EQ(grid.nearest(p, kWithin_m, facing(Eigen::Vector3f::UnitX())).index, nearest);
  }
  EXPECT_EQ(SurfaceGrid().nearest({0, 0, 0}, 1.0F, any_point).index, -1);
}

TEST(SurfaceGrid, HasLargerCellsWherePointsAreFarApart) {
  Surface surface(3);
  surface[1].position = {0.05F, 0.0F, 0.0F};
  surface[2].position = {3e4F, -3e4F, 3e4F};
  const SurfaceGrid grid(surface, 0.01F);
  EXPECT_EQ(grid.nearest({0.04F, 0, 0}, 0.02F, any_point).index, 1);
  EXPECT_EQ(grid.nearest(surface[2].position, 0.02F, any_point).index, 2);
  EXPECT_EQ(grid.nearest({1, 1, 1}, 0.02F, any_point).index, -1);
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
    const std::vector<ModelMatch> matches = index.nearest(views[i].descriptor, 3, 1e3F);
    ASSERT_EQ(matches.size(), 3U);
    EXPECT_EQ(matches[0].model, views[i].model);
    EXPECT_NEAR(matches[0].distance, 0.0F, 1e-3F);
    EXPECT_LE(matches[1].distance, matches[2].distance);
    // The same when what is farther off is not asked for.
    const float middle = (matches[1].distance + matches[2].distance) / 2;
    const std::vector<ModelMatch> near = index.nearest(views[i].descriptor, 3, middle);
    ASSERT_EQ(near.size(), 2U);
    EXPECT_EQ(near[1].model, matches[1].model);
    EXPECT_EQ(near[1].distance, matches[1].distance);
    EXPECT_EQ(index.nearest(views[i].descriptor, 1, middle).size(), 1U);
    const SizeAndColors beginning = views[i].descriptor.head<kSizeAndColors>();
    EXPECT_NEAR(index.least_distance(beginning), 0.0F, 1e-3F);
    ViewDescriptor other = views[i].descriptor;
    other.head<kSizeAndColors>().array() += 0.3F;
    other.tail<kShapeFeatureSize>().array() -= 0.2F;
    const float least = index.least_distance(other.head<kSizeAndColors>());
    EXPECT_GT(least, 0.0F);
    EXPECT_LE(least, index.nearest(other, 1, 1e3F)[0].distance);
  }
  EXPECT_GT(index.least_distance(SizeAndColors::Constant(1e3F)), 1.0F);
  EXPECT_EQ(ModelIndex({}).least_distance(SizeAndColors::Zero()),
            std::numeric_limits<float>::infinity());
  EXPECT_TRUE(ModelIndex({}).nearest(ViewDescriptor::Zero(), 3, 1.0F).empty());
}

TEST(ModelIndex, ComparesSizeAndShapeWithWhatHasNoColours) {
  constexpr std::size_t kWithout = 4;
  std::vector<IndexedView> views;
  for (std::size_t model = 0; model < 10; ++model) {
    ViewDescriptor descriptor;
    for (int k = 0; k < kViewDescriptorSize; ++k) {
      descriptor[k] =
          std::sin(1.0F + 7.0F * static_cast<float>(model) + 3.0F * static_cast<float>(k));
    }
    auto colors = descriptor.segment<6>(4);
    colors =
        model == kWithout ? Eigen::Matrix<float, 6, 1>::Zero().eval() : (60.0F * colors).eval();
    views.push_back({model, descriptor});
  }
  const ModelIndex index(views);
  for (const IndexedView& view : views) {
    ViewDescriptor other = view.descriptor;
    if (view.model == kWithout) {
      other.segment<6>(4).setConstant(60.0F);
    } else {
      other.segment<6>(4).setZero();
    }
    constexpr float kNear = 0.1F;
    EXPECT_FLOAT_EQ(index.least_distance(other.head<kSizeAndColors>()), 0.0F);
    const std::vector<ModelMatch> matches = index.nearest(other, 2, kNear);
    ASSERT_EQ(matches.size(), 1U);
    EXPECT_EQ(matches[0].model, view.model);
    EXPECT_FLOAT_EQ(matches[0].distance, 0.0F);
    other.head<4>().setConstant(1e3F);
    EXPECT_GT(index.least_distance(other.head<kSizeAndColors>()), kNear) << "of another size";
    EXPECT_TRUE(index.nearest(other, 2, kNear).empty());
  }
}

// Among many objects, another one would be more like what it is.
TEST(ObjectRecognizer, AsksOfFewObjectsThatMostOfThemIsSeen) {
  const MadeModel box = taught(box_on_table(kFourSides), kBox, "box");
  const ObjectRecognizer few({box.model}, 0.01F);
  const ObjectRecognizer many(std::vector<ObjectModel>(9, box.model), 0.01F);
  Placement placement;
  placement.is_distinct = true;
  placement.explained = placement.own = 1.0F;
  placement.seen = 0.4F;
  EXPECT_FALSE(few.is_recognized(placement));
  EXPECT_TRUE(many.is_recognized(placement));
  placement.seen = 0.6F;
  EXPECT_TRUE(few.is_recognized(placement));
}

Recognition with_light(std::size_t model, const Eigen::Vector3f& log_gain) {
  Recognition recognition;
  recognition.model = model;
  recognition.placement.seen = recognition.placement.explained = 1.0F;
  recognition.placement.light.log_gain = log_gain;
  return recognition;
}

TEST(SceneLights, AreThatOnWhichMostObjectsAgree) {
  const std::vector<Recognition> all = {
      with_light(0, {-0.2F, -0.4F, -0.8F}), with_light(1, {0.5F, 0.5F, 0.5F}),
      with_light(2, {-0.25F, -0.45F, -0.8F}), with_light(3, {-0.2F, -0.4F, -0.75F})};
  const SceneLights lights(all);
  ASSERT_TRUE(lights.of_most_objects());
  const SceneLight light = *lights.of_most_objects();
  EXPECT_LT((light.log_gain - Eigen::Vector3f(-0.22F, -0.42F, -0.78F)).norm(), 0.05F);
  EXPECT_EQ(lights.of(1).log_gain, light.log_gain);
  EXPECT_GT(light.agreement(all[0].placement.light), 0.95F);
  EXPECT_LT(light.agreement(all[1].placement.light), 0.01F);
  // A thing in the shadow, and one that is lit in another colour.
  EXPECT_GT(light.agreement({{-0.42F, -0.62F, -0.98F}}), 0.7F);
  EXPECT_LT(light.agreement({{-0.02F, -0.42F, -0.98F}}), 0.5F);
}

TEST(SceneLights, MayBeAnyAsLongAsTooFewObjectsTell) {
  const std::vector<Recognition> all = {with_light(0, {-0.2F, -0.4F, -0.8F}),
                                        with_light(1, {0.5F, 0.5F, 0.5F}),
                                        with_light(2, {-0.25F, -0.45F, -0.8F})};
  const SceneLights lights(all);
  EXPECT_FALSE(lights.of_most_objects());
  const SceneLight unknown = lights.of(0);
  EXPECT_EQ(unknown.log_gain, Eigen::Vector3f::Zero());
  EXPECT_GT(unknown.agreement(all[0].placement.light), 0.7F) << "it may be another one";
  EXPECT_LT(unknown.agreement({{-1.5F, -1.0F, -0.5F}}), 0.6F) << "as far as allowed";
}

const Eigen::Vector3f kDark = Eigen::Vector3f::Constant(-0.9F);
const Eigen::Vector3f kBright = Eigen::Vector3f::Constant(0.1F);

// Whatever is dark looks like a white thing in the dark: many such places of one object are one
// opinion.
TEST(SceneLights, AreNotThatOfManyPlacesOfOneObject) {
  std::vector<Recognition> all(9, with_light(0, kDark));
  EXPECT_FALSE(SceneLights(all).of_most_objects());
  for (const std::size_t model : {0, 1, 2}) all.push_back(with_light(model, kBright));
  const SceneLights lights(all);
  ASSERT_TRUE(lights.of_most_objects());
  EXPECT_LT((lights.of_most_objects()->log_gain - kBright).norm(), 1e-3F);
}

TEST(SceneLights, OfOneObjectAreThatInWhichItFitsBest) {
  std::vector<Recognition> all(9, with_light(0, kDark));
  for (Recognition& each : all) each.placement.explained = 0.7F;
  all.resize(12, with_light(0, kBright));
  const SceneLight light = SceneLights(all).of(0);
  EXPECT_LT((light.log_gain - kBright).norm(), 1e-3F);
  EXPECT_GT(light.agreement({kBright}), 0.95F);
  EXPECT_LT(light.agreement({kDark}), 0.1F);
  EXPECT_GT(SceneLights(all).of(1).agreement({kDark}), 0.6F) << "of another one it is not known";
  // Two are too few to tell, but they say that it is not the other one.
  all.resize(11);
  EXPECT_GT(SceneLights(all).of(0).agreement({kDark}), 0.6F);
  // That others agree does not make a light more likely than it is by itself.
  all.resize(9);
  const SceneLight dark = SceneLights(all).of(0);
  EXPECT_FLOAT_EQ(dark.agreement({kDark}), SceneLight().agreement({kDark}));
}

}  // namespace
}  // namespace kintsugi::segmenter
