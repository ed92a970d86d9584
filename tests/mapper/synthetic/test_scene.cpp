#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/synthetic/rooms/scenes.hpp"
#include "mapper/synthetic/scene/scene.hpp"
#include "mapper/synthetic/scene/scene_builder.hpp"

namespace kintsugi::synthetic {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

class Random {
 public:
  Vector3d point_in(const Vector3d& low, const Vector3d& high) {
    return low + Vector3d(uniform_(engine_), uniform_(engine_), uniform_(engine_))
                     .cwiseProduct(high - low);
  }
  Vector3d direction() {
    return Vector3d(normal_(engine_), normal_(engine_), normal_(engine_)).normalized();
  }

 private:
  std::mt19937 engine_{11};
  std::uniform_real_distribution<double> uniform_{0.0, 1.0};
  std::normal_distribution<double> normal_;
};

Vector3d to_object(const Primitive& primitive, const Vector3d& p_W) {
  return primitive.X_WO.inverse() * p_W;
}

TEST(Scene, DistancesOfTheTinyScenesAreTheClosedForm) {
  const Scene ball = make_scene("sphere");
  EXPECT_NEAR(ball.signed_distance({0, 0, 2}), 1.5, 1e-12);
  EXPECT_NEAR(ball.signed_distance({0.1, 0, 0}), -0.4, 1e-12);
  const Scene plane = make_scene("plane");
  EXPECT_NEAR(plane.signed_distance({0.3, -1, 0.7}), 0.7, 1e-12);
  EXPECT_NEAR(plane.signed_distance({0.3, -1, -0.02}), -0.02, 1e-12);
  const Scene room = make_scene("box-room");
  EXPECT_NEAR(room.signed_distance({0, 0, 0.3}), 0.3, 1e-12);
  EXPECT_NEAR(room.signed_distance({0, 0, 2.3}), 0.2, 1e-12);
  EXPECT_NEAR(room.signed_distance({-1.9, 0, 1.2}), 0.1, 1e-12);
}

TEST(Scene, NearestSurfaceIsWhoseInTheTinyScenes) {
  const Scene room = make_scene("box-room");
  const auto nearest_name = [&](const Vector3d& p_W) {
    return room.instances().at(room.nearest_surface(p_W).instance - 1).name;
  };
  EXPECT_EQ(nearest_name({0, 0, 0.01}), "floor");
  EXPECT_EQ(nearest_name({0, 0, -0.01}), "floor") << "within it";
  EXPECT_EQ(nearest_name({0, 0, 2.4}), "ceiling");
  EXPECT_EQ(nearest_name({-1.9, 0, 1.2}), "wall");
  EXPECT_EQ(nearest_name({-1.4, 1.4 - 0.25, 1.2}), "pillar");
  EXPECT_EQ(nearest_name({1.6, -0.3 - 0.19, 0.2}), "ball") << "within it";
  // On the red box stands the blue one: 3 cm from the edge between them, to either side of it.
  EXPECT_EQ(nearest_name({1.5, 0.8, 1.13}), "blue box");
  EXPECT_EQ(nearest_name({1.5 + 0.25, 0.8, 0.81}), "red box");
  EXPECT_TRUE(room.instances().at(0).is_structure) << room.instances().at(0).name;
  EXPECT_FALSE(room.instances().at(6).is_structure) << room.instances().at(6).name;
}

TEST(Scene, NearestSurfaceOfCoincidingSolidsIsTheFirst) {
  SceneBuilder builder;
  builder.add_object("first", at(0, 0, 0), box(1, 1, 1), {});
  builder.add_object("second", at(0, 0, 0), box(1, 1, 1), {});
  const Scene scene = std::move(builder).build();
  EXPECT_EQ(scene.nearest_surface({0, 0, 0.75}).instance, 1);
  EXPECT_EQ(scene.nearest_surface({0, 0, 0.25}).instance, 1);
  EXPECT_EQ(Scene({}, {}).nearest_surface({0, 0, 0}).instance, kNoInstance);
}

TEST(Scene, TreeFindsWhatBruteForceFinds) {
  constexpr double kRounding_m = 1e-12;  // of moving the ray into the solid's frame
  const Scene scene = make_scene("office");
  Random random;
  for (int i = 0; i < 3000; ++i) {
    const Vector3d origin = random.point_in({-1.9, -1.6, 0.1}, {1.9, 1.6, 2.3});
    const Vector3d direction = random.direction();
    std::vector<double> t;
    for (const Primitive& primitive : scene.primitives()) {
      t.push_back(intersect<double>(primitive.shape, to_object(primitive, origin),
                                    primitive.X_WO.linear().transpose() * direction));
    }
    const double nearest = *std::min_element(t.begin(), t.end());
    const auto hit = scene.intersect(origin, direction);
    ASSERT_EQ(hit.has_value(), std::isfinite(nearest));
    if (!hit) continue;
    EXPECT_NEAR(hit->t, nearest, kRounding_m);
    EXPECT_NEAR(t[hit->primitive], nearest, kRounding_m);  // of two that coincide, either
    EXPECT_EQ(hit->instance, scene.primitives()[hit->primitive].instance);
  }
}

TEST(Scene, DistanceIsTheSmallestOfAllSolids) {
  const Scene scene = make_scene("office");
  Random random;
  for (int i = 0; i < 3000; ++i) {
    const Vector3d p_W = random.point_in({-2.3, -2.0, -0.2}, {2.3, 2.0, 2.7});
    double smallest = kInfinity;
    int instance = kNoInstance;
    for (const Primitive& primitive : scene.primitives()) {
      const double distance = signed_distance(primitive.shape, to_object(primitive, p_W));
      if (distance < smallest) instance = primitive.instance;
      smallest = std::min(smallest, distance);
    }
    EXPECT_EQ(scene.signed_distance(p_W), smallest);
    EXPECT_EQ(scene.nearest_surface(p_W).instance, instance);
  }
}

// The two share no code: one marches by the distance, the other solves for the intersection.
TEST(Scene, RaysEndWhereTheDistanceIsZero) {
  constexpr double kTolerance_m = 1e-8;
  const Scene scene = make_scene("office");
  Random random;
  for (int i = 0; i < 2000; ++i) {
    const Vector3d origin = random.point_in({-1.9, -1.6, 0.1}, {1.9, 1.6, 2.3});
    if (scene.signed_distance(origin) <= 0.0) continue;
    const Vector3d direction = random.direction();
    const auto hit = scene.intersect(origin, direction);
    ASSERT_TRUE(hit.has_value()) << "the room is closed";
    EXPECT_NEAR(scene.signed_distance(hit->p_W), 0.0, kTolerance_m);
    for (double share : {0.1, 0.4, 0.7, 0.95}) {
      EXPECT_GT(scene.signed_distance(origin + share * hit->t * direction), 0.0);
    }
  }
}

TEST(Scene, EmptySceneIsFreeSpace) {
  const Scene scene({}, {});
  EXPECT_EQ(scene.signed_distance({0, 0, 0}), kInfinity);
  EXPECT_FALSE(scene.intersect({0, 0, 0}, {1, 0, 0}).has_value());
}

TEST(Scene, InstancesAreNumberedAndEachHasASolid) {
  for (const std::string& name : scene_names()) {
    const Scene scene = make_scene(name);
    std::vector<int> solids(scene.instances().size() + 1, 0);
    for (const Primitive& primitive : scene.primitives()) ++solids.at(primitive.instance);
    EXPECT_EQ(solids[kNoInstance], 0);
    for (std::size_t i = 0; i < scene.instances().size(); ++i) {
      EXPECT_EQ(scene.instances()[i].id, static_cast<int>(i) + 1);
      EXPECT_FALSE(scene.instances()[i].name.empty());
      EXPECT_FALSE(scene.instances()[i].shape.empty()) << name << scene.instances()[i].name;
      EXPECT_GT(solids[i + 1], 0);
    }
    EXPECT_LT(scene.instances().size(), 65536U) << "ids are 16 bit in rendered images";
  }
}

TEST(Scene, UnknownNameSaysWhatThereIs) {
  try {
    make_scene("cellar");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("cellar"));
    for (const std::string& name : scene_names()) EXPECT_THAT(error.what(), HasSubstr(name));
  }
}

TEST(Scene, PrimitiveOfNoInstanceIsRefused) {
  const std::vector<Primitive> stray = {
      {.shape = sphere(1), .X_WO = Pose::Identity(), .material = {}, .instance = 2}};
  EXPECT_THROW(
      Scene(stray, {Instance{.id = 1, .name = "a", .model = "", .key = "", .shape = "sphere"}}),
      std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi::synthetic
