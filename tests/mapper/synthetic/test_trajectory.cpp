#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "mapper/synthetic/render/renderer.hpp"
#include "mapper/synthetic/rooms/scenes.hpp"
#include "mapper/synthetic/rooms/trajectory.hpp"

namespace kintsugi::synthetic {
namespace {

using Eigen::Vector3d;

constexpr double kFrame_s = 1.0 / 30.0;

double angle_rad(const Pose& a, const Pose& b) {
  return Eigen::Quaterniond(a.linear()).angularDistance(Eigen::Quaterniond(b.linear()));
}

TEST(LookAt, ViewIsForwardAndTheImageIsUpright) {
  const Pose X_WC = look_at({1, 0, 1}, {1, 3, 1});
  EXPECT_TRUE((X_WC * Vector3d(0, 0, 3)).isApprox(Vector3d(1, 3, 1)));            // z forward
  EXPECT_TRUE((X_WC.linear() * Vector3d(0, 1, 0)).isApprox(Vector3d(0, 0, -1)));  // y down
  EXPECT_TRUE((X_WC.linear() * Vector3d(1, 0, 0)).isApprox(Vector3d(1, 0, 0)));   // x right
  EXPECT_NEAR(X_WC.linear().determinant(), 1.0, 1e-12);
}

TEST(LookAt, RefusesAVerticalViewAndNoView) {
  EXPECT_THROW(look_at({0, 0, 0}, {0, 0, 1}), std::invalid_argument);
  EXPECT_THROW(look_at({1, 2, 3}, {1, 2, 3}), std::invalid_argument);
}

TEST(FrameTime, IsTheNearestMicrosecondOfThirtyHertz) {
  EXPECT_EQ(frame_utime(0), 0);
  EXPECT_EQ(frame_utime(1), 33333);
  EXPECT_EQ(frame_utime(2), 66667);
  EXPECT_EQ(frame_utime(3), 100000);
  EXPECT_EQ(frame_utime(15240), 508'000'000);
}

TEST(Trajectory, GoesThroughItsEndsInTheTimeGiven) {
  const Trajectory path(
      {{{0, 0, 1}, {2, 0, 1}}, {{0.5, 0.3, 1}, {2, 0, 1}}, {{1, 0, 1}, {2, 1, 1}}},
      {.duration_s = 4, .shake_position_m = 0, .shake_orientation_rad = 0});
  EXPECT_TRUE(path.X_WC(0).isApprox(look_at({0, 0, 1}, {2, 0, 1}), 1e-9));
  EXPECT_TRUE(path.X_WC(4).isApprox(look_at({1, 0, 1}, {2, 1, 1}), 1e-9));
  EXPECT_TRUE(path.X_WC(99).isApprox(path.X_WC(4)));
  EXPECT_EQ(path.num_frames(), 121);
}

TEST(Trajectory, ShakeIsThatOfItsSeedAndBounded) {
  const auto shaken = [](std::uint32_t seed) {
    return Trajectory({{{0, 0, 1}, {2, 0, 1}}, {{1, 0, 1}, {2, 1, 1}}},
                      {.duration_s = 4, .shake_position_m = 0.002, .seed = seed});
  };
  const Trajectory still({{{0, 0, 1}, {2, 0, 1}}, {{1, 0, 1}, {2, 1, 1}}},
                         {.duration_s = 4, .shake_position_m = 0, .shake_orientation_rad = 0});
  EXPECT_TRUE(shaken(1).X_WC(1.7).isApprox(shaken(1).X_WC(1.7), 0.0));
  EXPECT_FALSE(shaken(1).X_WC(1.7).isApprox(shaken(2).X_WC(1.7), 1e-9));
  for (double t_s = 0; t_s < 4; t_s += 0.1) {
    const Vector3d moved = shaken(1).X_WC(t_s).translation() - still.X_WC(t_s).translation();
    EXPECT_LE(moved.cwiseAbs().maxCoeff(), 4 * 0.002);  // four sines on each axis
  }
}

TEST(Trajectory, AClosedPathCanBeWalkedSeveralTimes) {
  const Trajectory path = make_scene_with_path("loop").trajectory;
  ASSERT_TRUE(path.is_closed());
  const double lap_s = path.duration_s();
  for (const double t_s : {0.0, 12.3, 99.9}) {
    EXPECT_TRUE(path.X_WC(t_s, 3).isApprox(path.X_WC(t_s), 0.0)) << t_s;
    // The same but for the shake of the hand: four sines on each axis.
    const Pose moved = path.X_WC(t_s).inverse() * path.X_WC(t_s + 2 * lap_s, 3);
    EXPECT_LT(moved.translation().norm(), 2 * std::sqrt(3.0) * 4 * 0.002) << t_s;
    EXPECT_GT(moved.translation().norm(), 0.0) << t_s;
  }
  const Pose step = path.X_WC(lap_s - kFrame_s, 2).inverse() * path.X_WC(lap_s, 2);
  EXPECT_LT(step.translation().norm(), 0.03) << "from one lap to the next";
  EXPECT_FALSE(make_scene_with_path("office").trajectory.is_closed());
}

TEST(Trajectory, BadConfigurationIsRefused) {
  const std::vector<Waypoint> two = {{{0, 0, 1}, {2, 0, 1}}, {{1, 0, 1}, {2, 0, 1}}};
  EXPECT_THROW(Trajectory(two, {.duration_s = 0}), std::invalid_argument);
  EXPECT_THROW(Trajectory(two, {.shake_position_m = -1}), std::invalid_argument);
  EXPECT_THROW(Trajectory({two[0]}, {}), std::invalid_argument);
  EXPECT_THROW(Trajectory({two[0], two[0]}, {}), std::invalid_argument) << "does not move";
}

struct Expected {
  double length_m;
  double length_tolerance_m;
  int frames;
};

// The lengths and durations of the paper's three datasets (Table I).
const std::map<std::string, Expected>& paper() {
  static const std::map<std::string, Expected> kPaper = {{"office", {2.9, 0.3, 375}},
                                                         {"loop", {15.0, 1.0, 3001}},
                                                         {"two-floors", {110.0, 3.0, 15241}}};
  return kPaper;
}

TEST(Paths, HaveTheLengthAndDurationOfThePapersDatasets) {
  for (const auto& [name, expected] : paper()) {
    const Trajectory path = make_scene_with_path(name).trajectory;
    EXPECT_NEAR(path.length_m(), expected.length_m, expected.length_tolerance_m) << name;
    EXPECT_EQ(path.num_frames(), expected.frames) << name;
  }
}

TEST(Paths, AreAtHandHeldSpeedAndClearOfAnySurface) {
  constexpr double kMaxSpeed_m_per_s = 0.5;
  constexpr double kMaxTurn_rad_per_s = std::numbers::pi / 3;
  constexpr double kMinClearance_m = 0.3;
  for (const std::string& name : scene_names()) {
    const auto [scene, path] = make_scene_with_path(name);
    double speed = 0;
    double turn = 0;
    double clearance = std::numeric_limits<double>::infinity();
    for (int i = 1; i < path.num_frames(); ++i) {
      const Pose X_WA = path.X_WC((i - 1) * kFrame_s);
      const Pose X_WB = path.X_WC(i * kFrame_s);
      speed = std::max(speed, (X_WB.translation() - X_WA.translation()).norm() / kFrame_s);
      turn = std::max(turn, angle_rad(X_WA, X_WB) / kFrame_s);
      clearance = std::min(clearance, scene.signed_distance(X_WB.translation()));
    }
    EXPECT_LT(speed, kMaxSpeed_m_per_s) << name;
    EXPECT_LT(turn, kMaxTurn_rad_per_s) << name;
    EXPECT_GT(clearance, kMinClearance_m) << name;
  }
}

/// Quantiles of true depth over the whole path, every tenth frame.
std::vector<double> depth_quantiles_m(const std::string& name, const std::vector<double>& shares) {
  const auto [scene, path] = make_scene_with_path(name);
  std::vector<float> depths_m;
  for (int i = 0; i < path.num_frames(); i += 10) {
    const RenderedFrame frame =
        render(scene, centred_camera(160, 120, 525.0 / 4), path.X_WC(i * kFrame_s));
    std::copy_if(frame.depth_m.begin(), frame.depth_m.end(), std::back_inserter(depths_m),
                 [](float z) { return !std::isnan(z); });
  }
  std::sort(depths_m.begin(), depths_m.end());
  std::vector<double> quantiles_m;
  for (const double share : shares) {
    const double index = share * static_cast<double>(depths_m.size() - 1);
    quantiles_m.push_back(depths_m.at(static_cast<std::size_t>(index)));
  }
  return quantiles_m;
}

TEST(Paths, HallIsSeenFromAfarAndTheKitchenFromNearby) {
  const auto hall_m = depth_quantiles_m("hall", {0.25, 0.5, 0.9});
  EXPECT_GT(hall_m[0], 3.0);
  EXPECT_GT(hall_m[1], 3.5);
  EXPECT_LT(hall_m[1], 4.2);
  EXPECT_LT(hall_m[2], 6.0);
  const auto kitchen_m = depth_quantiles_m("kitchen", {0.05, 0.95});
  EXPECT_GT(kitchen_m[0], 1.0);
  EXPECT_LT(kitchen_m[1], 3.0);
  // The wall at its end is in view and within the range of every sensor, so that it determines how
  // far the camera has gone.
  EXPECT_LT(depth_quantiles_m("hallway", {0.95})[0], 4.5);
}

TEST(Paths, RoomsOfTheBatteryTakeTenSecondsAndTheKitchenFourteen) {
  for (const char* name : {"hall", "hallway", "kitchen"}) {
    const Trajectory path = make_scene_with_path(name).trajectory;
    EXPECT_EQ(path.num_frames(), name == std::string("kitchen") ? 421 : 301) << name;
    EXPECT_GT(path.length_m(), 2.0) << name;  // 0.2 to 0.4 m/s
    EXPECT_LT(path.length_m(), 4.0) << name;
  }
}

TEST(Paths, LoopEndsWhereItBegan) {
  const Trajectory path = make_scene_with_path("loop").trajectory;
  const Pose start = path.X_WC(0);
  const Pose end = path.X_WC(path.duration_s());
  EXPECT_LT((start.translation() - end.translation()).norm(), 0.05);
  EXPECT_LT(angle_rad(start, end), 0.1);
}

}  // namespace
}  // namespace kintsugi::synthetic
