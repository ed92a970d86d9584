#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "segmenter/core/parameters/presets.hpp"
#include "segmenter/core/points/transformed_points.hpp"
#include "segmenter/objects/model/make_model.hpp"
#include "segmenter/objects/recognition/surface.hpp"
#include "segmenter/objects/teaching/learned_parameters.hpp"
#include "segmenter/objects/teaching/refine.hpp"
#include "segmenter/objects/teaching/taught_surface.hpp"
#include "segmenter/objects/teaching/teach.hpp"
#include "tests/segmenter/objects/box_on_table.hpp"

namespace kintsugi::segmenter {
namespace {

using testing::box_on_table;
using ::testing::HasSubstr;
using testing::kBall;
using testing::kBox;
using testing::kBoxSize_m;
using testing::kTable;

KnownObject taught(const std::string& name, const ObservedMap& map, std::uint32_t id = kBox) {
  const TaughtSurface surface = surface_of_segments(map, {id});
  return taught_object(name, map, points_of(map, surface), surface, 1'700'000'000);
}

template <typename Function>
std::string error_of(const Function& function) {
  try {
    function();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

TEST(TaughtSurface, IsAllPointsOfTheSegments) {
  const ObservedMap map = box_on_table();
  const TaughtSurface surface = surface_of_segments(map, {kBall, kBox, kBall});
  EXPECT_EQ(surface.segment_ids, (std::vector<std::uint32_t>{kBox, kBall}));
  for (const std::uint32_t i : surface.indices) EXPECT_NE(map.segment_ids[i], kTable);
  EXPECT_EQ(points_of(map, surface).size(), surface.indices.size());
}

TEST(TaughtSurface, NamesTheIdsNextToOneThatDoesNotExist) {
  ObservedMap map = box_on_table();
  for (std::uint32_t& id : map.segment_ids) id *= 10;
  EXPECT_THAT(error_of([&] { surface_of_segments(map, {25}); }),
              HasSubstr("no segment 25 among its 3; the nearest ids are 20 and 30"));
  EXPECT_THAT(error_of([&] { surface_of_segments(map, {99}); }), HasSubstr("ids are 30"));
  EXPECT_THAT(error_of([&] { surface_of_segments(map, {}); }), HasSubstr("no segments"));
}

TEST(TaughtSurface, IsWhatIsWithinAVoxelOfGivenPoints) {
  const ObservedMap map = box_on_table();
  const TaughtSurface box = surface_of_segments(map, {kBox});
  std::vector<CloudPoint> points_W = points_of(map, box);
  for (CloudPoint& p : points_W) p.x += 0.002F;
  const TaughtSurface found = surface_at(map, points_W);
  EXPECT_EQ(found.segment_ids, std::vector<std::uint32_t>{kBox});
  EXPECT_GE(found.indices.size(), box.indices.size());
  EXPECT_LT(found.indices.size(), box.indices.size() + 100);  // a rim of the table
}

TEST(LearnedParameters, ArePresetWhereThatIsAsGoodAsAny) {
  const ObservedMap map = box_on_table();
  const LearnedParameters learned = learned_parameters(map, surface_of_segments(map, {kBall}));
  EXPECT_GT(learned.wholeness, 0.95);
  EXPECT_EQ(learned.parameters.scale, preset("objects").scale);
  EXPECT_EQ(learned.parameters.threshold, preset("objects").threshold);
  EXPECT_EQ(learned.parameters.resolution_m, map.resolution_m);
}

TEST(LearnedParameters, CountColorLessForAThingOfTwoColors) {
  testing::MapOfThings things;
  // A flat thing on a table, 3 cm above it, with a seam of two colours that the preset divides.
  things.add_face({-0.6F, -0.5F, 0}, {1.2F, 0, 0}, {0, 1.0F, 0}, {150, 140, 130}, kTable);
  things.add_face({-0.1F, -0.1F, 0.03F}, {0.1F, 0, 0}, {0, 0.2F, 0}, {250, 250, 250}, kBox);
  things.add_face({0.0F, -0.1F, 0.03F}, {0.1F, 0, 0}, {0, 0.2F, 0}, {10, 10, 40}, kBox);
  const ObservedMap map = things.take();
  const LearnedParameters learned = learned_parameters(map, surface_of_segments(map, {kBox}));
  EXPECT_GT(learned.wholeness, 0.99);
  EXPECT_LT(learned.parameters.color_weight, preset("objects").color_weight);
}

TEST(Teach, GivesAnObjectWithItsLesson) {
  const KnownObject object = taught("box", box_on_table());
  EXPECT_TRUE(object.model.has_up);
  EXPECT_TRUE(object.model.views_O.empty());  // the map has no views
  EXPECT_EQ(object.model.times_taught, 1);
  ASSERT_EQ(object.lessons.size(), 1U);
  Lesson lesson = object.lessons[0];
  ASSERT_TRUE(lesson.X_WO);
  const CloudPoint& first_O = object.model.points_O[0];
  const CloudPoint first_W = transformed(first_O, pose_of(*lesson.X_WO));
  const ObservedMap map = box_on_table();
  EXPECT_TRUE(std::ranges::any_of(map.points_W, [&](const CloudPoint& p) {
    return std::hypot(p.x - first_W.x, p.y - first_W.y, p.z - first_W.z) < 1e-3F;
  }));
  lesson.X_WO.reset();
  EXPECT_EQ(
      lesson,
      (Lesson{
          .map_name = "hall", .map_session = 7, .segment_ids = {kBox}, .time_s = 1'700'000'000}));
}

TEST(Teach, OfAMapWithoutLevelSurfacesDoesNotKnowWhichWayIsUp) {
  testing::MapOfThings things;
  things.add_ball(Eigen::Vector3f::Zero(), 0.2F, kBall);
  EXPECT_FALSE(taught("ball", things.take(), kBall).model.has_up);
}

TEST(Teach, RefusesWhatIsTooSmallToBeASegment) {
  testing::MapOfThings things;
  things.add_face({0, 0, 0}, {0.05F, 0, 0}, {0, 0.05F, 0}, {1, 2, 3}, kBox);
  const ObservedMap map = things.take();
  EXPECT_THAT(error_of([&] { taught("crumb", map); }), HasSubstr("has 25 points, at least 50"));
}

/// The box, seen from in front and from the right, turned and moved in the second map.
struct TwoLessons {
  KnownObject known = taught("box", box_on_table({"z", "-y", "x"}));
  KnownObject lesson;

  explicit TwoLessons(const std::vector<std::string>& sides, float turn_rad = 0.7F,
                      const Eigen::Vector3f& size_m = kBoxSize_m)
      : lesson(taught("box", box_on_table(sides, {-0.15F, 0.1F, 0.0F}, turn_rad, size_m))) {}
};

TEST(Refine, FindsHowTheThingWasMoved) {
  const TwoLessons two({"z", "-y", "x"});
  const ObservationFit fit = fit_observation(two.known.model, two.lesson.model);
  EXPECT_TRUE(fit.is_one_object());
  EXPECT_GT(fit.common, 0.9);
  EXPECT_GT(fit.agreement, 0.9);
  const Eigen::AngleAxisd turn(fit.X_OL.linear());
  EXPECT_NEAR(turn.angle(), 0.7, 0.05);
  EXPECT_LT(fit.X_OL.translation().norm(), 0.01);
}

TEST(Refine, AveragesTheSameSidesAndAddsTheOthers) {
  const TwoLessons same({"z", "-y", "x"});
  const Refinement again = refined(same.known, same.lesson);
  EXPECT_LT(again.num_added, same.known.model.points_O.size() / 50);
  EXPECT_EQ(again.object.model.times_taught, 2);
  ASSERT_EQ(again.object.lessons.size(), 2U);
  // Where the same point of the object lay in the second map.
  const Pose X_WO = pose_of(*again.object.lessons[1].X_WO);
  const Pose X_WL = pose_of(*same.lesson.lessons[0].X_WO);
  EXPECT_LT((X_WO * again.fit.X_OL * Eigen::Vector3d(0.1, 0, 0) - X_WL * Eigen::Vector3d(0.1, 0, 0))
                .norm(),
            1e-9);

  const TwoLessons other({"z", "-y", "-x"});
  const Refinement more = refined(other.known, other.lesson);
  // Only the ends of two sides tell where it is along x. The points of the third are 12 cm
  // beside the middle, and the origins are in the means of the points.
  const double apart_m = 2.0 * 0.12 * (16.0 * 12) / (24 * 16 + 24 * 12 + 16 * 12);
  EXPECT_LT((more.fit.X_OL.translation() - Eigen::Vector3d(-apart_m, 0.0, 0.0)).norm(), 0.01);
  const std::size_t side = std::size_t{16} * 12;
  EXPECT_GT(more.num_added, side * 8 / 10);
  EXPECT_LT(more.num_added, side * 12 / 10);
  Eigen::AlignedBox3f box_O;
  for (const CloudPoint& p : more.object.model.points_O) {
    box_O.extend(Eigen::Vector3f(p.x, p.y, p.z));
  }
  EXPECT_LT((box_O.sizes() - kBoxSize_m).cwiseAbs().maxCoeff(), 0.02F);
}

// Its light is that of its first lesson, by which it is looked for in the map of that.
TEST(Refine, KeepsTheLightOfTheFirstLesson) {
  const KnownObject known = taught("box", box_on_table({"z", "-y", "x"}));
  const ObservedMap noon = box_on_table({"z", "-y", "-x"}, {-0.15F, 0.1F, 0.0F}, 0.7F);
  ObservedMap dusk = noon;
  relight(dusk.points_W, {0.45F, 0.5F, 0.55F});
  const Refinement refinement = refined(known, taught("box", dusk));
  EXPECT_NEAR(refinement.fit.light.log_gain.x(), std::log(0.45F), 0.05F);
  const ObjectModel expected = refined(known, taught("box", noon)).object.model;
  for (const CloudPoint& p : refinement.object.model.points_O) {
    EXPECT_TRUE(std::ranges::any_of(expected.points_O,
                                    [&p](const CloudPoint& q) {
                                      return std::abs(p.red - q.red) < 10 &&
                                             std::abs(p.green - q.green) < 10 &&
                                             std::abs(p.blue - q.blue) < 10;
                                    }))
        << int{p.red} << ' ' << int{p.green} << ' ' << int{p.blue};
  }
}

TEST(Refine, RefusesAnotherThing) {
  const ObservedMap map = box_on_table();
  const KnownObject box = taught("box", map);
  const KnownObject ball = taught("ball", map, kBall);
  EXPECT_THAT(error_of([&] { refined(box, ball); }),
              HasSubstr("does not fit what is known of 'box'"));
  const TwoLessons larger({"z", "-y", "x"}, 0.7F, {0.36F, 0.26F, 0.12F});
  EXPECT_THAT(error_of([&] { refined(larger.known, larger.lesson); }), HasSubstr("does not fit"));
}

TEST(Refine, KeepsTheParametersOfTheMoreWholeLesson) {
  TwoLessons two({"z", "-y", "x"});
  two.known.wholeness = 0.5;
  two.lesson.wholeness = 0.8;
  two.lesson.model.parameters.scale = 0.007;
  EXPECT_EQ(refined(two.known, two.lesson).object.model.parameters.scale, 0.007);
  two.known.wholeness = 0.9;
  EXPECT_NE(refined(two.known, two.lesson).object.model.parameters.scale, 0.007);
}

TEST(Refine, TurnsTheViewsOfTheLesson) {
  TwoLessons two({"z", "-y", "x"});
  two.known.model.views_O = {Eigen::Vector3f(0, -1, 0)};
  two.lesson.model.views_O = {Eigen::Vector3f(0, -1, 0)};
  const auto& views_O = refined(two.known, two.lesson).object.model.views_O;
  ASSERT_EQ(views_O.size(), 2U);
  EXPECT_NEAR(views_O[0].dot(views_O[1]), std::cos(0.7F), 0.05F);
}

TEST(Refine, WorksWhereOneMapDidNotTellWhichWayIsUp) {
  const TwoLessons two({"z", "-y", "x"});
  const ObservedMap map = box_on_table({"z", "-y", "x"}, {-0.15F, 0.1F, 0.0F}, 0.7F);
  const TaughtSurface surface = surface_of_segments(map, {kBox});
  KnownObject lesson = two.lesson;
  const MadeModel made = make_model("box", points_of(map, surface), map.resolution_m, std::nullopt);
  lesson.model.points_O = made.model.points_O;
  lesson.model.has_up = false;
  const ObservationFit fit = fit_observation(two.known.model, lesson.model);
  EXPECT_TRUE(fit.is_one_object());
  EXPECT_TRUE(fit_observation(lesson.model, two.known.model).is_one_object());
}

}  // namespace
}  // namespace kintsugi::segmenter
