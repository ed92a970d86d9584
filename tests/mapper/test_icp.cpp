#include <Eigen/Cholesky>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "mapper/core/icp.hpp"
#include "tests/mapper/box_room.hpp"

namespace kintsugi::mapper {
namespace {

using testing::angle_rad;
using testing::distance_m;

Vector6d twist(double x, double y, double z, double a, double b, double c) {
  Vector6d xi;
  xi << x, y, z, a, b, c;
  return xi;
}

/// One frame pixel and one model pixel in front of the same camera.
struct Pair {
  SurfaceMap frame;
  SurfaceMap model;
};

/// Points with depths `frame_z` and `model_z` on the ray (x, y, 1), with the same normal.
Pair one_pair(float frame_z, float model_z, const Eigen::Vector3f& normal, double x = 0.0,
              double y = 0.0) {
  const Intrinsics camera{10.0, 10.0, -10.0 * x, -10.0 * y, 1, 1, {}};
  Pair pair{SurfaceMap(camera), SurfaceMap(camera)};
  pair.frame.depth_m(0, 0) = frame_z;
  pair.model.depth_m(0, 0) = model_z;
  pair.frame.set_normal(0, 0, normal);
  pair.model.set_normal(0, 0, normal);
  return pair;
}

TEST(DepthSigma, FollowsNguyensModel) {
  EXPECT_DOUBLE_EQ(depth_sigma_m(0.4), 0.0012);
  EXPECT_DOUBLE_EQ(depth_sigma_m(2.4), 0.0012 + 0.0019 * 4.0);
}

TEST(Linearize, WeighsAPairByTheInverseVarianceOfItsDepth) {
  const Pair pair = one_pair(2.0F, 2.01F, {0, 0, -1});
  const NormalEquations equations = linearize(pair.frame, pair.model, Pose::Identity(), {});
  const double weight = 1.0 / (depth_sigma_m(2.0) * depth_sigma_m(2.0));
  const double r = static_cast<double>(2.01F) - 2.0;  // n . (m - p) = -r
  ASSERT_EQ(equations.inliers, 1);
  // One float rounding of the difference: relative 1e-7 of 2 m against 1 cm is 2e-5.
  EXPECT_NEAR(equations.A(2, 2), weight, 1e-9 * weight);
  EXPECT_NEAR(equations.b(2), weight * r, 1e-4 * weight * r);
  EXPECT_NEAR(equations.weighted_squares, weight * r * r, 1e-4 * weight * r * r);
  EXPECT_NEAR(equations.squared_residuals_m2, r * r, 1e-4 * r * r);
}

TEST(Linearize, JacobianIsTheNumericDerivativeOfTheResidual) {
  const Pair pair = one_pair(1.5F, 1.52F, {0.36F, -0.48F, -0.8F}, 0.02, -0.01);
  IcpGates open;
  open.max_distance_m = 1.0;
  const NormalEquations equations = linearize(pair.frame, pair.model, Pose::Identity(), open);
  ASSERT_EQ(equations.inliers, 1);

  const Eigen::Vector3d p = 1.5 * Eigen::Vector3d(0.02, -0.01, 1.0);
  const Eigen::Vector3d m = 1.52 * Eigen::Vector3d(0.02, -0.01, 1.0);
  const Eigen::Vector3d n(0.36F, -0.48F, -0.8F);
  const auto residual = [&](const Vector6d& xi) { return n.dot(m - se3_retract(xi) * p); };
  constexpr double kStep = 1e-6;
  Vector6d jacobian;  // of the prediction n . X p, that is minus the residual's
  for (int k = 0; k < 6; ++k) {
    const Vector6d xi = kStep * Vector6d::Unit(k);
    jacobian(k) = -(residual(xi) - residual(-xi)) / (2.0 * kStep);
  }
  const double weight = 1.0 / std::pow(depth_sigma_m(1.5F), 2);
  // The code computes the moment from floats: 1e-6 of entries of the order of 1.
  EXPECT_LT((equations.A / weight - jacobian * jacobian.transpose()).norm(), 1e-5);
  EXPECT_LT((equations.b / weight - jacobian * residual(Vector6d::Zero())).norm(), 1e-6);
}

TEST(Linearize, RejectsPairsOutsideTheGates) {
  const IcpGates gates{0.1, 0.8};
  const Pair near = one_pair(2.0F, 2.09F, {0, 0, -1});
  EXPECT_EQ(linearize(near.frame, near.model, Pose::Identity(), gates).inliers, 1);
  const Pair far_apart = one_pair(2.0F, 2.11F, {0, 0, -1});
  EXPECT_EQ(linearize(far_apart.frame, far_apart.model, Pose::Identity(), gates).inliers, 0);
  Pair tilted = one_pair(2.0F, 2.0F, {0, 0, -1});
  tilted.frame.set_normal(0, 0, {0.0F, 0.66F, -0.75F});  // cosine 0.75
  EXPECT_EQ(linearize(tilted.frame, tilted.model, Pose::Identity(), gates).inliers, 0);
}

TEST(Linearize, InvalidPixelsTakeNoPart) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Eigen::Vector3f invalid = Eigen::Vector3f::Constant(nan);
  const Pair no_depth = one_pair(nan, 2.0F, {0, 0, -1});
  EXPECT_EQ(linearize(no_depth.frame, no_depth.model, Pose::Identity(), {}).inliers, 0);
  Pair no_normal = one_pair(2.0F, 2.0F, {0, 0, -1});
  no_normal.frame.set_normal(0, 0, invalid);
  EXPECT_EQ(linearize(no_normal.frame, no_normal.model, Pose::Identity(), {}).inliers, 0);
  Pair no_model = one_pair(2.0F, nan, {0, 0, -1});
  no_model.model.set_normal(0, 0, invalid);
  const NormalEquations equations = linearize(no_model.frame, no_model.model, Pose::Identity(), {});
  EXPECT_EQ(equations.inliers, 0);
  EXPECT_TRUE(equations.A.isZero());
  // Behind the model's camera.
  Pose X_VC = Pose::Identity();
  X_VC.translation().z() = -3.0;
  const Pair behind = one_pair(2.0F, 2.0F, {0, 0, -1});
  EXPECT_EQ(linearize(behind.frame, behind.model, X_VC, {}).inliers, 0);
}

TEST(Linearize, CountsPointsBehindAndInFrontOfTheModel) {
  const auto agreement = [](float frame_z, float model_z) {
    Pair pair = one_pair(frame_z, model_z, {0, 0, -1});
    pair.frame.normal_z(0, 0) = std::numeric_limits<float>::quiet_NaN();  // is not asked for
    return linearize(pair.frame, pair.model, Pose::Identity(), {}).agreement;
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(agreement(nan, 1.0F).overlap, 0);
  EXPECT_EQ(agreement(1.0F, nan).overlap, 0);
  // At 1 m three sigma are 6 mm, so 2 cm decide; at 3 m they are 42 mm.
  const auto expect = [&](float frame_z, float model_z, int behind, int in_front) {
    const SurfaceAgreement counts = agreement(frame_z, model_z);
    EXPECT_EQ(counts.overlap, 1);
    EXPECT_EQ(counts.behind, behind) << frame_z << " against " << model_z;
    EXPECT_EQ(counts.in_front, in_front) << frame_z << " against " << model_z;
  };
  expect(1.019F, 1.0F, 0, 0);
  expect(1.021F, 1.0F, 1, 0);
  expect(0.979F, 1.0F, 0, 1);
  expect(3.0F, 2.96F, 0, 0);
  expect(3.0F, 2.957F, 1, 0);
  expect(3.0F, 3.043F, 0, 1);
}

TEST(Linearize, IteratingFindsAKnownMotionInAnExactRoom) {
  const Pose X_WV = testing::looking_at_the_crate();
  const SurfaceMap model = testing::render_room(X_WV, testing::test_camera());
  for (const Vector6d& motion :
       {twist(0.02, -0.01, 0.015, 0, 0, 0), twist(0, 0, 0, 0.015, -0.02, 0.01),
        twist(-0.015, 0.02, 0.01, 0.01, 0.015, -0.02)}) {
    const Pose X_VC_true = se3_retract(motion);
    const SurfaceMap frame = testing::render_room(X_WV * X_VC_true, testing::test_camera());
    Pose X_VC = Pose::Identity();
    for (int i = 0; i < 15; ++i) {
      const NormalEquations equations = linearize(frame, model, X_VC, {});
      X_VC = se3_retract(equations.A.ldlt().solve(equations.b)) * X_VC;
    }
    // On planes the point-to-plane error of exact data vanishes at the truth alone; what remains is
    // the pairs across creases (points within 10 cm and 37 degrees), none here: float rounding.
    EXPECT_LT(distance_m(X_VC, X_VC_true), 1e-5);
    EXPECT_LT(angle_rad(X_VC, X_VC_true), 1e-5);
  }
}

TEST(Linearize, SameBitsWhateverTheThreads) {
  const Pose X_WV = testing::looking_at_the_crate();
  const SurfaceMap model = testing::render_room(X_WV, testing::test_camera());
  const Pose X_VC = se3_retract(twist(0.01, 0.02, 0.01, 0.01, 0.0, 0.02));
  const auto with_threads = [&](int threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return linearize(model, model, X_VC, {});
  };
  const NormalEquations one = with_threads(1);
  const NormalEquations four = with_threads(4);
  EXPECT_EQ(one.A, four.A);
  EXPECT_EQ(one.b, four.b);
  EXPECT_EQ(one.weighted_squares, four.weighted_squares);
}

TEST(Retraction, RotatesAboutTheAxisAndTranslates) {
  const Pose X = se3_retract(twist(1, 2, 3, 0, 0, M_PI / 2));
  EXPECT_LT((X * Eigen::Vector3d::UnitX() - Eigen::Vector3d(1, 3, 3)).norm(), 1e-12);
  EXPECT_TRUE(se3_retract(Vector6d::Zero()).isApprox(Pose::Identity()));
}

}  // namespace
}  // namespace kintsugi::mapper
