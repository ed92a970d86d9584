#include <Eigen/Cholesky>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "mapper/core/kernels/instruction_set.hpp"
#include "mapper/core/registration/icp.hpp"
#include "tests/mapper/core/box_room.hpp"

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

const DepthNoise kNoise;  ///< of the frames below
const InfluenceLimits kLimits{.full_sigmas = 3.0, .none_sigmas = 9.0};

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

TEST(Linearize, WeighsAPairByTheInverseVarianceOfItsDepth) {
  const Pair pair = one_pair(2.0F, 2.01F, {0, 0, -1});
  const NormalEquations equations = linearize(pair.frame, pair.model, Pose::Identity(), {});
  const double weight = 1.0 / kNoise.variance_m2(2.0);
  const double r = static_cast<double>(2.01F) - 2.0;  // n . (m - p) = -r
  ASSERT_EQ(equations.inliers, 1);
  // One float rounding of the difference: relative 1e-7 of 2 m against 1 cm is 2e-5.
  EXPECT_NEAR(equations.A(2, 2), weight, 1e-6 * weight);
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
  const double weight = 1.0 / kNoise.variance_m2(1.5);
  // The code computes the moment from floats: 1e-6 of entries of the order of 1.
  EXPECT_LT((equations.A / weight - jacobian * jacobian.transpose()).norm(), 1e-5);
  EXPECT_LT((equations.b / weight - jacobian * residual(Vector6d::Zero())).norm(), 1e-6);
}

TEST(Linearize, LimitsTheInfluenceOfLargeResiduals) {
  const double sigma_m = kNoise.sigma_m(1.0);
  // Between 3 and 9 deviations the influence falls from 3 to 0.
  for (const auto& [amount, influence] :
       {std::pair{0.0, 0.0}, {2.9, 2.9}, {3.0, 3.0}, {5.0, 2.0}, {8.0, 0.5}, {9.5, 0.0}}) {
    for (const double sign : {-1.0, 1.0}) {
      const auto model_z = static_cast<float>(1.0 - sign * amount * sigma_m);
      const Pair pair = one_pair(1.0F, model_z, {0, 0, -1});
      const NormalEquations limited =
          linearize(pair.frame, pair.model, Pose::Identity(), {}, kLimits);
      // One float rounding of the depths is 1e-7 m of deviations of 2 mm: 1e-4.
      EXPECT_NEAR(limited.b(2) * sigma_m, -sign * influence, 1e-3) << sign * amount;
      const NormalEquations whole = linearize(pair.frame, pair.model, Pose::Identity(), {});
      EXPECT_EQ(limited.A, whole.A);
      EXPECT_EQ(limited.weighted_squares, whole.weighted_squares);
      EXPECT_NEAR(whole.b(2) * sigma_m, -sign * amount, 1e-3);
    }
  }
}

TEST(Linearize, RejectsPairsOutsideTheGates) {
  const IcpGates gates{.max_distance_m = 0.1, .max_distance_sigmas = 0.0, .min_normal_cosine = 0.8};
  const Pair near = one_pair(2.0F, 2.09F, {0, 0, -1});
  EXPECT_EQ(linearize(near.frame, near.model, Pose::Identity(), gates).inliers, 1);
  const Pair far_apart = one_pair(2.0F, 2.11F, {0, 0, -1});
  EXPECT_EQ(linearize(far_apart.frame, far_apart.model, Pose::Identity(), gates).inliers, 0);
  Pair tilted = one_pair(2.0F, 2.0F, {0, 0, -1});
  tilted.frame.set_normal(0, 0, {0.0F, 0.66F, -0.75F});  // cosine 0.75
  EXPECT_EQ(linearize(tilted.frame, tilted.model, Pose::Identity(), gates).inliers, 0);
}

TEST(Linearize, LetsNoisyPointsBeFartherApart) {
  // Three deviations of 40 mm allow for 12 cm, the motion for 5 cm: 13 cm together.
  const IcpGates gates{.max_distance_m = 0.05, .max_distance_sigmas = 3.0};
  for (const auto& [distance_m, inliers] : {std::pair{0.129F, 1}, {0.131F, 0}}) {
    Pair pair = one_pair(2.0F, 2.0F + distance_m, {0, 0, -1});
    pair.frame.noise = {.base_m = 0.04, .share = 0.0, .growth_per_m = 0.0};
    EXPECT_EQ(linearize(pair.frame, pair.model, Pose::Identity(), gates).inliers, inliers);
  }
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
  // At 1 m three sigma are 6 mm, so 2 cm decide; at 3 m they are 44.7 mm.
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
  expect(3.0F, 2.955F, 1, 0);
  expect(3.0F, 3.045F, 0, 1);
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

/// The definition of InfluenceLimits.
double limited(double residual_sigmas, const InfluenceLimits& limits) {
  const double amount = std::abs(residual_sigmas);
  if (amount <= limits.full_sigmas) return residual_sigmas;
  if (amount >= limits.none_sigmas) return 0.0;
  const double share = (limits.none_sigmas - amount) / (limits.none_sigmas - limits.full_sigmas);
  return std::copysign(limits.full_sigmas * share, residual_sigmas);
}

/// linearize() in double and pixel by pixel.
NormalEquations slow_linearize(const SurfaceMap& frame_C, const SurfaceMap& model_V,
                               const Pose& X_VC, const IcpGates& gates,
                               const InfluenceLimits& limits) {
  NormalEquations sums;
  const Intrinsics& camera = model_V.intrinsics;
  for (int v = 0; v < frame_C.depth_m.rows; ++v) {
    for (int u = 0; u < frame_C.depth_m.cols; ++u) {
      const Eigen::Vector3d p = X_VC * frame_C.point(v, u).cast<double>();
      if (std::isnan(p.z()) || p.z() <= 0.0) continue;
      const double model_u = std::floor(camera.fx * p.x() / p.z() + camera.cx + 0.5);
      const double model_v = std::floor(camera.fy * p.y() / p.z() + camera.cy + 0.5);
      if (model_u < 0 || model_v < 0 || model_u >= camera.width || model_v >= camera.height) {
        continue;
      }
      const int row = static_cast<int>(model_v);
      const int col = static_cast<int>(model_u);
      const Eigen::Vector3d m = model_V.point(row, col).cast<double>();
      if (std::isnan(m.z())) continue;
      const double sigma = frame_C.noise.sigma_m(frame_C.depth_m(v, u));
      const double tolerance = std::max(0.02, 3.0 * sigma);
      sums.agreement.overlap += 1;
      sums.agreement.behind += p.z() > m.z() + tolerance ? 1 : 0;
      sums.agreement.in_front += p.z() < m.z() - tolerance ? 1 : 0;
      const Eigen::Vector3d n = model_V.normal(row, col).cast<double>();
      const Eigen::Vector3d frame_normal = X_VC.linear() * frame_C.normal(v, u).cast<double>();
      if (!((m - p).norm() < std::hypot(gates.max_distance_m, gates.max_distance_sigmas * sigma))) {
        continue;
      }
      if (!(frame_normal.dot(n) > gates.min_normal_cosine)) continue;
      Vector6d jacobian;
      jacobian << n, p.cross(n);
      const double residual = n.dot(m - p);
      sums.A += jacobian * jacobian.transpose() / (sigma * sigma);
      sums.b += jacobian * limited(residual / sigma, limits) / sigma;
      sums.weighted_squares += residual * residual / (sigma * sigma);
      sums.squared_residuals_m2 += residual * residual;
      ++sums.inliers;
    }
  }
  return sums;
}

/// Two views of a room, with holes, a stretch without normals, and a width that fills no register.
class RoomPair : public ::testing::Test {
 protected:
  RoomPair() {
    const Intrinsics camera = testing::test_camera(203, 149);
    const Pose X_WV = testing::looking_at_the_crate();
    model_ = testing::render_room(X_WV, camera);
    frame_ = testing::render_room(X_WV * X_VC_, camera);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    frame_.depth_m(cv::Rect(20, 30, 37, 11)).setTo(nan);
    frame_.depth_m(cv::Rect(100, 60, 30, 30)) *= 1.2F;  // behind the model
    frame_.depth_m(cv::Rect(5, 70, 30, 60)) *= 1.02F;   // farther off than noise, but inliers
    for (cv::Mat* plane : {&frame_.normal_x, &frame_.normal_y, &frame_.normal_z}) {
      (*plane)(cv::Rect(150, 5, 9, 70)).setTo(nan);
    }
    for (cv::Mat* plane : {&model_.depth_m, &model_.normal_x, &model_.normal_y, &model_.normal_z}) {
      (*plane)(cv::Rect(60, 80, 13, 29)).setTo(nan);
    }
  }
  const Pose X_VC_ = se3_retract(twist(0.02, -0.01, 0.03, 0.01, -0.02, 0.015));
  SurfaceMap frame_;
  SurfaceMap model_;
};

TEST_F(RoomPair, GivesTheSumsOfASlowReference) {
  const IcpGates gates;
  const Pose X_VC = X_VC_ * se3_retract(twist(0.004, 0.003, -0.005, 0.002, 0.001, -0.003));
  const NormalEquations slow = slow_linearize(frame_, model_, X_VC, gates, kLimits);
  const NormalEquations fast = linearize(frame_, model_, X_VC, gates, kLimits);
  ASSERT_GT(slow.inliers, 15'000);
  const NormalEquations without = linearize(frame_, model_, X_VC, gates);
  ASSERT_GT((without.b - slow.b).norm(), 0.05 * slow.b.norm());
  ASSERT_GT(slow.agreement.behind, 500);
  // A pixel in ten thousand falls on the other side of a rounding or a gate in single precision.
  EXPECT_NEAR(fast.inliers, slow.inliers, 5);
  EXPECT_NEAR(fast.agreement.overlap, slow.agreement.overlap, 5);
  EXPECT_NEAR(fast.agreement.behind, slow.agreement.behind, 5);
  EXPECT_NEAR(fast.agreement.in_front, slow.agreement.in_front, 5);
  // So these differ by about as much.
  EXPECT_LT((fast.A - slow.A).norm(), 2e-4 * slow.A.norm());
  EXPECT_LT((fast.b - slow.b).norm(), 2e-4 * slow.b.norm());
  EXPECT_NEAR(fast.weighted_squares, slow.weighted_squares, 1e-3 * slow.weighted_squares);
  EXPECT_NEAR(fast.squared_residuals_m2, slow.squared_residuals_m2,
              1e-3 * slow.squared_residuals_m2);
}

TEST_F(RoomPair, MayHaveTwoSizesOfImages) {
  const SurfaceMap small_frame =
      testing::render_room(testing::looking_at_the_crate() * X_VC_, testing::test_camera(75, 131));
  const NormalEquations slow = slow_linearize(small_frame, model_, X_VC_, {}, kLimits);
  const NormalEquations fast = linearize(small_frame, model_, X_VC_, {}, kLimits);
  ASSERT_GT(slow.inliers, 3'000);
  EXPECT_NEAR(fast.inliers, slow.inliers, 3);
  EXPECT_LT((fast.A - slow.A).norm(), 1e-3 * slow.A.norm());  // three pixels of these
}

void expect_same_bits(const NormalEquations& a, const NormalEquations& b) {
  EXPECT_EQ(a.A, b.A);
  EXPECT_EQ(a.b, b.b);
  EXPECT_EQ(a.weighted_squares, b.weighted_squares);
  EXPECT_EQ(a.squared_residuals_m2, b.squared_residuals_m2);
  EXPECT_EQ(a.inliers, b.inliers);
  EXPECT_EQ(a.agreement.overlap, b.agreement.overlap);
  EXPECT_EQ(a.agreement.behind, b.agreement.behind);
  EXPECT_EQ(a.agreement.in_front, b.agreement.in_front);
}

TEST_F(RoomPair, GivesTheSameBitsWithEveryInstructionSet) {
  const NormalEquations portable =
      linearize(frame_, model_, X_VC_, {}, kLimits, kernels_for(InstructionSet::kPortable));
  for (const InstructionSet set : kInstructionSets) {
    if (!is_supported(set)) continue;
    SCOPED_TRACE(name_of(set));
    expect_same_bits(linearize(frame_, model_, X_VC_, {}, kLimits, kernels_for(set)), portable);
  }
}

TEST_F(RoomPair, GivesTheSameBitsWhateverTheThreads) {
  const auto with_threads = [&](int threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return linearize(frame_, model_, X_VC_, {});
  };
  expect_same_bits(with_threads(1), with_threads(4));
}

TEST(Retraction, RotatesAboutTheAxisAndTranslates) {
  const Pose X = se3_retract(twist(1, 2, 3, 0, 0, M_PI / 2));
  EXPECT_LT((X * Eigen::Vector3d::UnitX() - Eigen::Vector3d(1, 3, 3)).norm(), 1e-12);
  EXPECT_TRUE(se3_retract(Vector6d::Zero()).isApprox(Pose::Identity()));
}

}  // namespace
}  // namespace kintsugi::mapper
