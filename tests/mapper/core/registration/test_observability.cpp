#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "mapper/core/registration/observability.hpp"
#include "tests/mapper/core/box_room.hpp"

namespace kintsugi::mapper {
namespace {

using Eigen::Vector3d;

constexpr double kSigma_m = 0.004;

Vector6d row_of(const Vector3d& normal, const Vector3d& point) {
  Vector6d row;
  row << normal, point.cross(normal);
  return row;
}

/// Pairs of points and normals; each side of a pair sees the normal with its own scatter.
class Pairs {
 public:
  explicit Pairs(double scatter_rad) : scatter_rad_(scatter_rad) {}

  void add(const Vector3d& point, const Vector3d& normal) {
    const double weight = 1.0 / (kSigma_m * kSigma_m);
    const Vector6d a = row_of(scattered(normal), point);
    const Vector6d b = row_of(scattered(normal), point);
    information_.A += weight * a * a.transpose();
    information_.C += 0.5 * weight * (a * b.transpose() + b * a.transpose());
  }
  /// A rectangle around `centre`, spanned by two vectors.
  void add_plane(const Vector3d& centre, const Vector3d& side_a, const Vector3d& side_b) {
    constexpr int kHalf = 15;
    const Vector3d normal = side_a.cross(side_b).normalized();
    for (int i = -kHalf; i <= kHalf; ++i) {
      for (int j = -kHalf; j <= kHalf; ++j) {
        add(centre + (i * side_a + j * side_b) / (2.0 * kHalf), normal);
      }
    }
  }
  ObservableSplit split() const {
    return split_observable(information_, Matrix6d::Identity(), ObservabilityConfig());
  }
  const Information& information() const { return information_; }

 private:
  Vector3d scattered(const Vector3d& normal) {
    Vector3d noisy = normal;
    for (int axis = 0; axis < 3; ++axis) noisy[axis] += scatter_rad_ * gauss_(random_);
    return noisy.normalized();
  }

  double scatter_rad_;
  std::mt19937 random_{7};
  std::normal_distribution<double> gauss_;
  Information information_;
};

/// The share of `twist` that lies outside the span of `basis`: 0 inside, 1 orthogonal.
double distance_from(const TwistBasis& basis, const Vector6d& twist) {
  const Eigen::MatrixXd columns = basis;
  return (twist - columns * columns.colPivHouseholderQr().solve(twist)).norm() / twist.norm();
}

Vector6d twist(const Vector3d& translation, const Vector3d& rotation) {
  Vector6d xi;
  xi << translation, rotation;
  return xi;
}

// The scatter of a raycast normal after one frame is 0.14 rad, after fifty 0.02 rad.
class Observability : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Scatter, Observability, ::testing::Values(0.0, 0.02, 0.14));

// Open directions come from sums of 961 noisy normals: they lean by about 0.14 / sqrt(961).
constexpr double kLean = 0.03;

TEST_P(Observability, PlaneLeavesThreeOfSixDirectionsOpen) {
  Pairs pairs(GetParam());
  const Vector3d centre(0.2, -0.1, 1.5);
  pairs.add_plane(centre, {1.6, 0, 0}, {0, 1.2, 0});
  const ObservableSplit split = pairs.split();
  ASSERT_EQ(split.open.cols(), 3);
  ASSERT_EQ(split.determined.cols(), 3);
  const Vector3d normal = Vector3d::UnitZ();
  EXPECT_LT(distance_from(split.open, twist(Vector3d::UnitX(), Vector3d::Zero())), kLean);
  EXPECT_LT(distance_from(split.open, twist(Vector3d::UnitY(), Vector3d::Zero())), kLean);
  EXPECT_LT(distance_from(split.open, twist(centre.cross(normal), normal)), kLean);
  EXPECT_LT(split.least_reliability, 0.1);
}

TEST_P(Observability, CorridorLeavesOneDirectionOpen) {
  Pairs pairs(GetParam());
  pairs.add_plane({-0.9, 0, 2}, {0, 2, 0}, {0, 0, 3});
  pairs.add_plane({0.9, 0, 2}, {0, 0, 3}, {0, 2, 0});
  pairs.add_plane({0, 1.2, 2}, {0, 0, 3}, {1.8, 0, 0});
  const ObservableSplit split = pairs.split();
  ASSERT_EQ(split.open.cols(), 1);
  EXPECT_LT(distance_from(split.open, twist(Vector3d::UnitZ(), Vector3d::Zero())), kLean);
}

TEST_P(Observability, CornerDeterminesEverything) {
  Pairs pairs(GetParam());
  pairs.add_plane({-0.9, 0, 2}, {0, 2, 0}, {0, 0, 2});
  pairs.add_plane({0, 1, 2}, {0, 0, 2}, {1.8, 0, 0});
  pairs.add_plane({0, 0, 3}, {1.8, 0, 0}, {0, 2, 0});
  const ObservableSplit split = pairs.split();
  EXPECT_EQ(split.open.cols(), 0);
  EXPECT_GT(split.least_reliability, 0.5);
}

TEST_P(Observability, SphereLeavesRotationsAboutItsCentreOpen) {
  Pairs pairs(GetParam());
  const Vector3d centre(0.1, 0.0, 1.5);
  for (double polar = 0.05; polar < 1.5; polar += 0.05) {
    for (double azimuth = 0.0; azimuth < 6.28; azimuth += 0.2) {
      const Vector3d normal(std::sin(polar) * std::cos(azimuth),
                            std::sin(polar) * std::sin(azimuth), -std::cos(polar));
      pairs.add(centre + 0.4 * normal, normal);
    }
  }
  const ObservableSplit split = pairs.split();
  ASSERT_EQ(split.open.cols(), 3);
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d about = Vector3d::Unit(axis);
    // x = about x (p - centre): the centre stays.
    EXPECT_LT(distance_from(split.open, twist(-about.cross(centre), about)), kLean);
  }
}

TEST(ObservableSplit, StaysInTheSpaceItIsGiven) {
  Information information;
  information.A = information.C = 1e6 * Matrix6d::Identity();
  TwistBasis space(6, 2);
  space << twist({1, 0, 0}, {0, 0, 0}), twist({0, 0, 0}, {0, 1, 0});
  information.A(0, 0) = information.C(0, 0) = 0.0;
  const ObservableSplit split = split_observable(information, space, ObservabilityConfig());
  ASSERT_EQ(split.open.cols(), 1);
  ASSERT_EQ(split.determined.cols(), 1);
  EXPECT_LT(distance_from(split.open, space.col(0)), 1e-12);
  EXPECT_LT(distance_from(split.determined, space.col(1)), 1e-12);
  const ObservableSplit none = split_observable(information, TwistBasis(6, 0), {});
  EXPECT_EQ(none.open.cols() + none.determined.cols(), 0);
}

/// Three walls of different size, so that some directions are known better than others.
Information of_a_corner(double scatter_rad) {
  Pairs pairs(scatter_rad);
  pairs.add_plane({-0.9, 0, 2}, {0, 2, 0}, {0, 0, 2});
  pairs.add_plane({0, 1, 2}, {0, 0, 0.5}, {0.5, 0, 0});
  pairs.add_plane({0, 0, 3}, {1.8, 0, 0}, {0, 2, 0});
  return pairs.information();
}

TEST(PureInformation, OfCleanNormalsIsAllOfIt) {
  const Information information = of_a_corner(0.0);
  const PureInformation pure = pure_information(information, Matrix6d::Identity(), {});
  EXPECT_LT((pure.information - information.A).norm(), 1e-9 * information.A.norm());
  EXPECT_LT((pure.weighting - Matrix6d::Identity()).norm(), 1e-6);
}

TEST(PureInformation, IsWhatTheWeightingLeavesOfTheInformation) {
  for (const double scatter_rad : {0.0, 0.1, 0.3}) {
    const Information information = of_a_corner(scatter_rad);
    TwistBasis some(6, 2);
    some << twist({1, 0, 0.5}, {0, 0, 0}), twist({0, 0, 0}, {0, 1, 0});
    for (const TwistBasis& space : {TwistBasis(Matrix6d::Identity()), some}) {
      const PureInformation pure = pure_information(information, space, {});
      const Matrix6d& W = pure.weighting;
      const Eigen::MatrixXd left = space.transpose() * W.transpose() * information.A * W * space;
      const Eigen::MatrixXd expected = space.transpose() * pure.information * space;
      EXPECT_LT((left - expected).norm(), 1e-9 * expected.norm()) << scatter_rad;
    }
  }
}

TEST(PureInformation, IsTheUnbiasedPartInTheDirectionsThatItKeeps) {
  // Both sides of a pair scatter by 0.3 rad: a part of A is noise, none of C.
  const Information information = of_a_corner(0.3);
  const PureInformation pure = pure_information(information, Matrix6d::Identity(), {});
  EXPECT_LT((pure.information - information.C).norm(), 1e-9 * information.C.norm());
  EXPECT_LT(pure.information.trace(), 0.99 * information.A.trace());
}

TEST(PureInformation, OfNoiseIsZero) {
  Pairs plane(0.14);
  plane.add_plane({0.2, -0.1, 1.5}, {1.6, 0, 0}, {0, 1.2, 0});
  const TwistBasis open = plane.split().open;
  ASSERT_EQ(open.cols(), 3);
  const PureInformation pure = pure_information(plane.information(), open, {});
  EXPECT_EQ(pure.information.norm(), 0.0);
  EXPECT_EQ(pure.weighting.norm(), 0.0);
  const PureInformation nowhere = pure_information(plane.information(), TwistBasis(6, 0), {});
  EXPECT_EQ(nowhere.information.norm(), 0.0);
}

TEST(PureInformation, KeepsAWeakCleanDirectionBesideNoise) {
  // A bare wall, and a narrow strip that faces sideways.
  Pairs pairs(0.14);
  pairs.add_plane({0, 0, 3}, {2, 0, 0}, {0, 2, 0});
  for (int i = 0; i < 60; ++i) pairs.add({0.5, -1.0 + i / 30.0, 2.8}, Vector3d::UnitX());
  TwistBasis sideways(6, 2);
  sideways << twist({1, 0, 0}, {0, 0, 0}), twist({0, 1, 0}, {0, 0, 0});
  const PureInformation pure = pure_information(pairs.information(), sideways, {});
  const double strip = 60.0 / (kSigma_m * kSigma_m);
  EXPECT_NEAR(pure.information(0, 0), strip, 0.15 * strip);
  EXPECT_LT(pure.information(1, 1), 0.05 * strip);
}

// The sums over a wall are not exactly zero along it, and may be negative.
TEST(PureInformation, IsFiniteInFrontOfExactWallsInAnyDirection) {
  const Intrinsics camera = testing::test_camera(80, 60);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> tilt(-0.6, 0.6);
  for (int i = 0; i < 200; ++i) {
    const Vector3d normal = Vector3d(tilt(random), tilt(random), -1.0).normalized();
    SurfaceMap wall(camera);
    for (int v = 0; v < camera.height; ++v) {
      for (int u = 0; u < camera.width; ++u) {
        const Vector3d ray((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1.0);
        wall.depth_m(v, u) = static_cast<float>(-1.5 / normal.dot(ray));
        wall.set_normal(v, u, normal.cast<float>());
      }
    }
    const Information information =
        independent(geometric_information(wall, wall, Pose::Identity(), {}), wall.depth_m.total());
    const ObservableSplit split = split_observable(information, Matrix6d::Identity(), {});
    ASSERT_EQ(split.open.cols(), 3) << normal.transpose();
    const PureInformation pure = pure_information(information, split.open, {});
    ASSERT_TRUE(pure.information.allFinite()) << normal.transpose();
    ASSERT_TRUE(pure.weighting.allFinite()) << normal.transpose();
    const Eigen::MatrixXd along_wall = split.open.transpose() * pure.information * split.open;
    // split.open is scaled to the prior's information: 1e-3 of that is nothing.
    EXPECT_LT(along_wall.norm(), 1e-3) << normal.transpose();
  }
}

TEST(GeometricInformation, OfTheSamePicturesIsThatOfThePointToPlaneSystem) {
  const SurfaceMap surface =
      testing::render_room(testing::looking_at_the_crate(), testing::test_camera(80, 60));
  const Information information = geometric_information(surface, surface, Pose::Identity(), {});
  const NormalEquations equations = linearize(surface, surface, Pose::Identity(), {});
  // Both sum in single precision.
  EXPECT_LT((information.A - equations.A).norm(), 1e-4 * equations.A.norm());
  EXPECT_LT((information.C - equations.A).norm(), 1e-4 * equations.A.norm());
}

TEST(ObservabilityConfig, NamesTheFieldOutOfRange) {
  ObservabilityConfig config;
  config.prior_m = 0.0;
  EXPECT_THROW(config.validate(), std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi::mapper
