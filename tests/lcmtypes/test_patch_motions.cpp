#include <bit>
#include <limits>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "lcmtypes/patch_motions.hpp"
#include "tests/support/example_messages.hpp"

namespace kintsugi {
namespace {

Pose random_pose(std::mt19937& random) {
  std::normal_distribution<double> normal;
  Pose X = Pose::Identity();
  X.linear() = Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
                   .normalized()
                   .matrix();
  X.translation() << normal(random), normal(random), normal(random);
  return X;
}

CloudSlice patch(std::int32_t id, std::int32_t correction, const Pose& X_WP) {
  CloudSlice slice = testing::example_patch(1, id);
  slice.correction = correction;
  slice.X_WP = X_WP;
  return slice;
}

const std::int32_t kPart = testing::example_slice(0).part;  // of the patches, and corrections

CloudSlice correction(std::int32_t number, std::vector<PatchMotion> motions) {
  CloudSlice slice = testing::example_correction(0, 100 + number);
  slice.correction = number;
  slice.motions = std::move(motions);
  return slice;
}

Pose shift(double x_m) { return Pose(Eigen::Translation3d(x_m, 0.0, 0.0)); }

TEST(PatchPose, RoundsAPoseToSingleAndNotToLess) {
  std::mt19937 random(1);
  for (int i = 0; i < 1'000; ++i) {
    const Pose X = random_pose(random);
    const Pose rounded = PatchPose(X).pose();
    // A quaternion of floats is exact to 3e-8 in each number.
    EXPECT_TRUE(rounded.linear().isApprox(X.linear(), 3e-7));
    EXPECT_TRUE(rounded.translation().isApprox(X.translation(), 1e-7));
    EXPECT_TRUE((rounded.linear().transpose() * rounded.linear()).isIdentity(1e-14));
  }
}

TEST(PatchPose, OnlyTheIdentityIsOne) {
  EXPECT_TRUE(PatchPose().is_identity());
  EXPECT_TRUE(PatchPose(Pose::Identity()).is_identity());
  EXPECT_EQ(PatchPose(Pose::Identity()), PatchPose());
  EXPECT_EQ(PatchPose().pose().matrix(), Pose::Identity().matrix());
  EXPECT_FALSE(PatchPose(shift(1e-9)).is_identity());
  EXPECT_FALSE(PatchPose(testing::example_pose()).is_identity());
}

TEST(PatchPose, MovesPointsAndTurnsNormals) {
  CloudPoint point;
  point.x = 1.0F;
  point.y = 2.0F;
  point.z = 3.0F;
  point.nx = 1.0F;
  point.weight = 5.0F;
  Pose X_WP = shift(10.0);
  X_WP.linear() = Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ()).matrix();
  const CloudPoint result = moved(std::vector{point}, X_WP).at(0);
  EXPECT_NEAR(result.x, 8.0F, 1e-6F);
  EXPECT_NEAR(result.y, 1.0F, 1e-6F);
  EXPECT_NEAR(result.z, 3.0F, 1e-6F);
  EXPECT_NEAR(result.nx, 0.0F, 1e-6F);
  EXPECT_NEAR(result.ny, 1.0F, 1e-6F);
  EXPECT_EQ(result.weight, 5.0F);
}

TEST(PatchPose, TheIdentityKeepsEveryBit) {
  CloudPoint point;
  point.x = -0.0F;
  point.y = std::numeric_limits<float>::infinity();
  const CloudPoint result = moved(std::vector{point}, PatchPose()).at(0);
  EXPECT_EQ(std::bit_cast<std::uint32_t>(result.x), std::bit_cast<std::uint32_t>(-0.0F));
  EXPECT_EQ(result.y, point.y);
}

TEST(PatchMotions, TheHighestCorrectionDecidesInEveryOrder) {
  const CloudSlice first = correction(1, {{5, shift(1.0)}, {6, shift(1.5)}});
  const CloudSlice second = correction(2, {{5, shift(2.0)}});
  PatchMotions forward;
  EXPECT_EQ(forward.learn(first).size(), 2U);
  EXPECT_EQ(forward.learn(second).size(), 1U);
  PatchMotions backward;
  EXPECT_EQ(backward.learn(second), (std::vector<PlacedPatch>{{5, {shift(2.0), 2, kPart}}}));
  EXPECT_EQ(backward.learn(first), (std::vector<PlacedPatch>{{6, {shift(1.5), 1, kPart}}}));
  EXPECT_TRUE(backward.learn(second).empty());
  EXPECT_EQ(forward.places(), backward.places());
  EXPECT_EQ(forward.places().at(5), (PatchPlace{shift(2.0), 2, kPart}));
}

TEST(PatchMotions, AHeaderCountsUnlessACorrectionIsNewer) {
  PatchMotions motions;
  motions.learn(correction(2, {{5, shift(2.0)}}));
  EXPECT_EQ(motions.place_of(patch(5, 1, shift(1.0))), (PatchPlace{shift(2.0), 2, kPart}));
  EXPECT_EQ(motions.place_of(patch(5, 2, shift(3.0))), (PatchPlace{shift(3.0), 2, kPart}));
  EXPECT_EQ(motions.place_of(patch(5, 4, shift(4.0))), (PatchPlace{shift(4.0), 4, kPart}));
  EXPECT_EQ(motions.place_of(patch(6, 0, shift(0.0))), (PatchPlace{{}, 0, kPart}));
}

TEST(PatchMotions, ACorrectionBringsItsPatchesIntoItsPart) {
  CloudSlice joined = correction(2, {{5, shift(2.0)}});
  joined.part = 0;
  PatchMotions motions;
  motions.learn(joined);
  EXPECT_EQ(motions.place_of(patch(5, 1, shift(1.0))).part, 0);
  EXPECT_EQ(motions.place_of(patch(6, 1, shift(1.0))).part, kPart) << "it did not name this one";
  EXPECT_EQ(motions.place_of(testing::example_slice(1)).part, kPart) << "of a slice that stays";
}

}  // namespace
}  // namespace kintsugi
