#include <random>

#include <gtest/gtest.h>

#include "lcmtypes/trajectory.hpp"
#include "mapper/core/relocalization/feature_pose.hpp"

namespace kintsugi::mapper {
namespace {

/// A wall 3 m away, with small things on it, seen from two places. Of the features that match only
/// `inlier_share` are on the same point.
struct Wall {
  ImageFeatures features_K;
  ImageFeatures features_C;
  Pose X_KC = Pose::Identity();

  Wall(int num_features, double inlier_share, unsigned seed = 1) {
    X_KC.translation() << 0.3, -0.1, 0.2;
    X_KC.linear() = Eigen::AngleAxisd(0.15, Eigen::Vector3d(0.3, 1.0, 0.2).normalized()).matrix();
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> across(-1.0, 1.0);
    std::uniform_real_distribution<double> off_wall(-0.02, 0.02);
    std::normal_distribution<float> noise(0.0F, 0.5F / 525.0F);
    cv::Mat_<std::uint8_t> descriptors(num_features, 32);
    for (std::uint8_t& byte : descriptors) byte = static_cast<std::uint8_t>(random());
    features_K.descriptors = descriptors;
    features_C.descriptors = descriptors.clone();
    const auto seen_at = [&](const Eigen::Vector3d& p) {
      return cv::Point2f(static_cast<float>(p.x() / p.z()) + noise(random),
                         static_cast<float>(p.y() / p.z()) + noise(random));
    };
    for (int i = 0; i < num_features; ++i) {
      const Eigen::Vector3d p_K(across(random), across(random), 3.0 + off_wall(random));
      const Eigen::Vector3d other_K(across(random), across(random), 3.0);
      features_K.rays_C.push_back(seen_at(p_K));
      features_K.depths_m.push_back(static_cast<float>(p_K.z()));
      features_C.rays_C.push_back(
          seen_at(X_KC.inverse() * (i < inlier_share * num_features ? p_K : other_K)));
      features_C.depths_m.push_back(1.0F);
    }
  }
};

TEST(FeaturePose, OfAWallAgreesWithItsInliers) {
  for (const double inlier_share : {1.0, 0.7, 0.5, 0.4}) {
    const Wall wall(100, inlier_share);
    const auto X_KC = pose_from_features(wall.features_K, wall.features_C);
    ASSERT_TRUE(X_KC) << inlier_share;
    const Pose X_CC = X_KC->inverse() * wall.X_KC;
    EXPECT_LT(X_CC.translation().norm(), 0.02) << inlier_share;
    EXPECT_LT(rotation_angle_rad(X_CC), 0.01) << inlier_share;
  }
}

/// All must agree: a few samples of noisy points may not be enough.
TEST(FeaturePose, NeedsNoMoreThanTwelveFeatures) {
  int num_found = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    const Wall wall(12, 1.0, seed);
    num_found += pose_from_features(wall.features_K, wall.features_C).has_value() ? 1 : 0;
  }
  EXPECT_GE(num_found, 70);
  const Wall few(11, 1.0);
  EXPECT_FALSE(pose_from_features(few.features_K, few.features_C));
}

TEST(FeaturePose, IsTheSameEachTime) {
  const Wall wall(60, 0.5);
  const auto once = pose_from_features(wall.features_K, wall.features_C);
  const auto again = pose_from_features(wall.features_K, wall.features_C);
  ASSERT_TRUE(once && again);
  EXPECT_EQ(once->matrix(), again->matrix());
}

TEST(FeaturePose, IsNoneWhereNothingAgrees) {
  const Wall wall(100, 0.0);
  EXPECT_FALSE(pose_from_features(wall.features_K, wall.features_C));
}

}  // namespace
}  // namespace kintsugi::mapper
