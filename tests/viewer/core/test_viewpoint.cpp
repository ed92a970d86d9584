#include <algorithm>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "tests/viewer/support/synthetic_room.hpp"
#include "viewer/core/camera/viewpoint.hpp"

namespace kintsugi::viewer {
namespace {

constexpr double kRounding = 1e-9;  // of double precision at some metres and hundreds of pixels

Eigen::Vector2d project(const VirtualCamera& camera, const Eigen::Vector3d& p_W) {
  const Eigen::Vector3d p_V = camera.X_WV.inverse() * p_W;
  const Intrinsics& k = camera.intrinsics;
  return {k.fx * p_V.x() / p_V.z() + k.cx, k.fy * p_V.y() / p_V.z() + k.cy};
}

TEST(LookAt, PutsTheTargetIntoTheMiddleAndUpUp) {
  const Eigen::Vector3d up_W = -Eigen::Vector3d::UnitY();
  const VirtualCamera camera{pinhole(641, 481, 0.9), look_at({1, -2, -3}, {0, 0.5, 2}, up_W)};
  EXPECT_TRUE(project(camera, {0, 0.5, 2}).isApprox(Eigen::Vector2d(320, 240), kRounding));
  EXPECT_LT(project(camera, {0, 0.3, 2}).y(), 240.0);  // above: a smaller v
  EXPECT_NEAR(1.0, camera.X_WV.linear().determinant(), kRounding);
  EXPECT_NEAR(320.0, project(camera, Eigen::Vector3d(0, 0.5, 2) + up_W).x(), kRounding);
}

TEST(LookAt, GivesARotationAlsoStraightDownAndAtItself) {
  for (const Eigen::Vector3d& target_W : {Eigen::Vector3d(0, 5, 0), Eigen::Vector3d(0, 0, 0)}) {
    const Pose X_WV = look_at(Eigen::Vector3d::Zero(), target_W, -Eigen::Vector3d::UnitY());
    EXPECT_TRUE((X_WV.linear() * X_WV.linear().transpose()).isIdentity(kRounding));
  }
}

TEST(FitPoints, SeesAllPointsAndIsNoFartherThanItMust) {
  std::mt19937 random(1);
  std::normal_distribution<double> coordinate;
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<Eigen::Vector3d> points_W(200);
    for (Eigen::Vector3d& p_W : points_W) {
      p_W = {4.0 * coordinate(random), coordinate(random), 3.0 * coordinate(random)};
    }
    const Intrinsics intrinsics = pinhole(640, 360, 0.9);
    const Eigen::Matrix3d R_WV = look_down({0, -1, 0}, 0.1 * trial, 0.7);
    constexpr double kMargin_px = 10.0;
    const VirtualCamera camera = fit_points(points_W, 0.0, R_WV, intrinsics, kMargin_px);
    double gap_u = 1e9;
    double gap_v = 1e9;
    for (const Eigen::Vector3d& p_W : points_W) {
      // From the middle, cx = 319.5, the picture reaches 320 px to both sides.
      const Eigen::Vector2d uv = project(camera, p_W);
      gap_u = std::min(gap_u, 320.0 - std::abs(uv.x() - 319.5));
      gap_v = std::min(gap_v, 180.0 - std::abs(uv.y() - 179.5));
      EXPECT_GT((camera.X_WV.inverse() * p_W).z(), 0.0);
    }
    EXPECT_GE(gap_u, kMargin_px - 1e-6);
    EXPECT_GE(gap_v, kMargin_px - 1e-6);
    EXPECT_NEAR(kMargin_px, std::min(gap_u, gap_v), 1e-6);  // one side is tight
  }
}

TEST(FitPoints, MayLeaveOutliersOut) {
  std::vector<Eigen::Vector3d> points_W(999, Eigen::Vector3d(0, 0, 1));
  points_W.emplace_back(1000, 0, 0);
  const VirtualCamera camera =
      fit_points(points_W, 0.002, Eigen::Matrix3d::Identity(), pinhole(100, 100, 0.9), 1.0);
  EXPECT_LT(camera.X_WV.translation().norm(), 2.0);
}

TEST(UpDirection, IsMinusYWithoutPoints) {
  EXPECT_EQ(Eigen::Vector3d(0, -1, 0), UpDirection().up_W());
}

TEST(UpDirection, FindsTheFloorWhenTheFirstCameraWasTilted) {
  // The room is level; seen from a camera that looked down by the angle, it is turned the other
  // way.
  for (const double tilt_rad : {-0.6, -0.3, 0.0, 0.2, 0.5}) {
    const Eigen::Matrix3f R =
        Eigen::AngleAxisd(tilt_rad, Eigen::Vector3d::UnitX()).toRotationMatrix().cast<float>();
    UpDirection up;
    for (CloudSlice slice : make_room(4.0, 0.05).slices) {
      for (CloudPoint& p : slice.points_W) {
        const Eigen::Vector3f n = R * Eigen::Vector3f(p.nx, p.ny, p.nz);
        p.nx = n.x();
        p.ny = n.y();
        p.nz = n.z();
      }
      up.add(slice.points_W);
    }
    const Eigen::Vector3d expected = R.cast<double>() * Eigen::Vector3d(0, -1, 0);
    // The ball's normals lie evenly about up; what is left is rounding of single precision.
    EXPECT_GT(up.up_W().dot(expected), std::cos(0.01)) << tilt_rad;
  }
}

TEST(UpDirection, PassesOverWhatIsNoUnitNormal) {
  std::vector<CloudPoint> points(100);
  for (CloudPoint& p : points) p.nx = std::numeric_limits<float>::quiet_NaN();
  points.emplace_back().ny = 5.0F;
  UpDirection up;
  up.add(points);
  EXPECT_EQ(Eigen::Vector3d(0, -1, 0), up.up_W());
}

TEST(UpDirection, IsTheSameToTheLastBitInWhateverOrderPointsComeAndGo) {
  std::vector<CloudSlice> slices = make_room(4.0, 0.05).slices;
  UpDirection in_order;
  for (const CloudSlice& slice : slices) in_order.add(slice.points_W);
  std::mt19937 random(5);
  for (int trial = 0; trial < 20; ++trial) {
    std::ranges::shuffle(slices, random);
    UpDirection up;
    for (const CloudSlice& slice : slices) {
      up.add(slices.front().points_W);  // a revision that is replaced
      up.add(slice.points_W);
      up.remove(slices.front().points_W);
    }
    EXPECT_EQ(in_order.up_W(), up.up_W());
  }
}

TEST(CameraAround, PassesOverPointsThatAreNotFinite) {
  std::vector<CloudSlice> slices = make_room(4.0, 0.05).slices;
  ReceivedMap clean(slices.front().session);
  ReceivedMap spoilt(slices.front().session);
  for (CloudSlice& slice : slices) {
    clean.add_slice(slice);
    slice.points_W.front().x = std::numeric_limits<float>::quiet_NaN();
    slice.points_W.back().y = std::numeric_limits<float>::infinity();
    spoilt.add_slice(slice);
  }
  const auto eye_W = [](const ReceivedMap& map) -> Eigen::Vector3d {
    return camera_at(OverviewViewpoint{}, map, 0, {}, 640, 480, {}).X_WV.translation();
  };
  // Every second point is looked at; without two in a slice the others are shifted by one.
  EXPECT_LT((eye_W(clean) - eye_W(spoilt)).norm(), 0.05);
  for (const PointChunk& chunk : spoilt.chunks(0)) {
    EXPECT_TRUE(chunk.box_W.min().allFinite() && chunk.box_W.max().allFinite());
  }
}

TEST(ParseViewpoint, ReadsEachKindAndRefusesTheRest) {
  EXPECT_TRUE(std::holds_alternative<FollowViewpoint>(parse_viewpoint("follow")));
  EXPECT_TRUE(std::holds_alternative<OverviewViewpoint>(parse_viewpoint("overview")));
  const auto fixed = std::get<FixedViewpoint>(parse_viewpoint("1,-2.5,3,0,0,1e1"));
  EXPECT_EQ(Eigen::Vector3d(1, -2.5, 3), fixed.eye_W);
  EXPECT_EQ(Eigen::Vector3d(0, 0, 10), fixed.target_W);
  for (const char* text : {"", "Follow", "1,2,3", "1,2,3,4,5", "1,2,3,4,5,6,7", "1,2,3,4,5,x",
                           "1,2,3,4,5,6 ", "1,2,3,4,5,inf", "1,2,3,4,5,nan", "1,2,3,1,2,3"}) {
    EXPECT_THROW(parse_viewpoint(text), std::invalid_argument) << text;
  }
}

TEST(SmoothedCamera, GlidesTowardsThePoseAndKeepsItsHeadingLevel) {
  const Eigen::Vector3d up_W = -Eigen::Vector3d::UnitY();
  SmoothedCamera depth_camera;
  EXPECT_FALSE(depth_camera.has_pose());
  CameraPose pose;
  pose.state = TrackingState::kTracking;
  pose.utime = 1'000'000;
  pose.X_WC.linear() =
      Eigen::AngleAxisd(-0.5, Eigen::Vector3d::UnitX()).toRotationMatrix();  // looks down
  depth_camera.update(pose, up_W);
  EXPECT_TRUE(depth_camera.has_pose());
  EXPECT_TRUE(depth_camera.heading_W().isApprox(Eigen::Vector3d::UnitZ(), kRounding));

  // The pose jumps by a metre: after one time constant of 1 s, 1 - 1/e of the way is gone.
  pose.X_WC.translation().x() = 1.0;
  pose.utime += 1'000'000;
  depth_camera.update(pose, up_W);
  EXPECT_NEAR(1.0 - std::exp(-1.0), depth_camera.position_W().x(), kRounding);

  pose.state = TrackingState::kLost;
  pose.utime += 1'000'000;
  depth_camera.update(pose, up_W);
  EXPECT_NEAR(1.0 - std::exp(-1.0), depth_camera.position_W().x(), kRounding);
}

TEST(FollowViewpoint, SeesTheCameraAndTheMapAboutItFromBehindAndAbove) {
  const SyntheticMap room = make_room(12.0, 0.05);
  ReceivedMap map(room.slices.front().session);
  for (const CloudSlice& slice : room.slices) map.add_slice(slice);
  SmoothedCamera depth_camera;
  const CameraPose& pose = room.poses[room.poses.size() / 2];
  depth_camera.update(pose, map.up(0).up_W());

  const ViewpointConfig config;
  const VirtualCamera camera = camera_at(FollowViewpoint{}, map, 0, depth_camera, 640, 480, config);
  const Eigen::Vector3d forward_W = camera.X_WV.linear().col(2);
  const Eigen::Vector3d from_camera_W = camera.X_WV.translation() - pose.X_WC.translation();
  EXPECT_LT(from_camera_W.dot(depth_camera.heading_W()), 0.0);
  EXPECT_LT(from_camera_W.y(), 0.0);  // y is down

  const auto is_seen = [&](const Eigen::Vector3d& p_W) {
    const Eigen::Vector2d uv = project(camera, p_W);
    return uv.x() > 0.0 && uv.x() < 639.0 && uv.y() > 0.0 && uv.y() < 479.0;
  };
  EXPECT_TRUE(is_seen(pose.X_WC.translation()));
  int near_points = 0;
  int unseen = 0;
  for (const CloudSlice& slice : room.slices) {
    for (const CloudPoint& p : slice.points_W) {
      const Eigen::Vector3d p_W(p.x, p.y, p.z);
      if (forward_W.dot(Eigen::Vector3d(p.nx, p.ny, p.nz)) > 0.0) continue;
      if ((p_W - pose.X_WC.translation()).norm() > config.follow_radius_m) continue;
      ++near_points;
      unseen += is_seen(p_W) ? 0 : 1;
    }
  }
  // The view is fitted to every second point of these 50,000 to 100,000; what lies beyond the
  // outermost of them is within the margin.
  EXPECT_GT(near_points, 10'000);
  EXPECT_EQ(0, unseen);
}

}  // namespace
}  // namespace kintsugi::viewer
