#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/patch_motions.hpp"
#include "mapper/core/slices/common_surface.hpp"

namespace kintsugi::mapper {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;
using Name = CommonSurface::Name;
using Names = std::vector<Name>;

constexpr double kVoxel_m = 0.01;
constexpr Name kOwn{.session = CommonSurface::kOwnSession, .id = 1};
constexpr Name kGuest{.session = 8, .id = 3};
constexpr Name kLaterGuest{.session = 9, .id = 4};

CloudPoint point(const Eigen::Vector3d& position, const Eigen::Vector3d& normal) {
  CloudPoint p;
  p.weight = 20.0F;
  p.x = static_cast<float>(position.x());
  p.y = static_cast<float>(position.y());
  p.z = static_cast<float>(position.z());
  p.nx = static_cast<float>(normal.x());
  p.ny = static_cast<float>(normal.y());
  p.nz = static_cast<float>(normal.z());
  return p;
}

/// A floor at height z, 20 x 20 points a voxel apart, from x_m on.
std::vector<CloudPoint> floor_from(double x_m, double z_m = 0.0) {
  std::vector<CloudPoint> points;
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 20; ++j) {
      points.push_back(point({x_m + i * kVoxel_m, j * kVoxel_m, z_m}, Eigen::Vector3d::UnitZ()));
    }
  }
  return points;
}

std::vector<CloudPoint> wall() {
  std::vector<CloudPoint> points = floor_from(0.0);
  for (CloudPoint& p : points) {
    p.nx = p.nz;
    p.nz = 0.0F;
  }
  return points;
}

Names names(const std::vector<CommonSurface::Rest>& patches) {
  Names names;
  for (const auto& patch : patches) names.push_back(patch.name);
  return names;
}

std::vector<CloudPoint> seen(float times, std::vector<CloudPoint> points) {
  for (CloudPoint& p : points) p.weight = times;
  return points;
}

struct CommonSurfaceTest : ::testing::Test {
  CommonSurface common{{.same = {}, .resolution_m = kVoxel_m, .keeps_own = false}};
};

TEST_F(CommonSurfaceTest, IsThatOfThisCamera) {
  common.set(kOwn, floor_from(0.0), {});
  common.set(kGuest, floor_from(0.105, 0.01), {});
  // The floor of this camera ends at 0.19, and a point there stands for what is a voxel around it.
  const auto rest = common.take(kGuest);
  EXPECT_THAT(rest, SizeIs(10 * 20));
  for (const CloudPoint& p : rest) EXPECT_GT(p.x, 0.2F);
  EXPECT_EQ(common.take(kOwn), floor_from(0.0));
}

TEST_F(CommonSurfaceTest, IsThatOfWhoHasSeenItTwiceAsOften) {
  common.set(kOwn, seen(31, floor_from(0.0)), {});
  common.set(kGuest, seen(17, floor_from(0.0)), {});
  EXPECT_THAT(common.take(kOwn), SizeIs(400));
  EXPECT_THAT(common.take(kGuest), IsEmpty());
  common.set(kGuest, seen(32, floor_from(0.0)), {});
  const auto better = common.take_changed(10);
  ASSERT_EQ(names(better), Names{kOwn});
  EXPECT_THAT(better[0].points_P, IsEmpty());
  EXPECT_THAT(common.take(kGuest), SizeIs(400));
  common.set(kOwn, seen(40, floor_from(0.0)), {});
  EXPECT_THAT(common.take(kOwn), SizeIs(400));
  EXPECT_THAT(common.take_changed(10).at(0).points_P, IsEmpty());
}

TEST(CommonSurface, IsThatOfThisCameraIfItKeepsItsOwn) {
  CommonSurface common({.same = {}, .resolution_m = kVoxel_m, .keeps_own = true});
  common.set(kOwn, seen(8, floor_from(0.0)), {});
  common.set(kGuest, seen(100, floor_from(0.0)), {});
  EXPECT_THAT(common.take(kOwn), SizeIs(400));
  EXPECT_THAT(common.take(kGuest), IsEmpty());
}

TEST_F(CommonSurfaceTest, IsNotAnotherSurface) {
  common.set(kOwn, floor_from(0.0), {});
  common.set(kGuest, floor_from(0.0, 0.014), {});
  EXPECT_THAT(common.take(kGuest), IsEmpty());
  common.set(kGuest, floor_from(0.0, 0.016), {});
  EXPECT_THAT(common.take(kGuest), SizeIs(400)) << "more than a voxel and a half apart";
  common.set(kGuest, wall(), {});
  EXPECT_THAT(common.take(kGuest), SizeIs(400)) << "normals differ";
}

TEST_F(CommonSurfaceTest, IsNotOfOneRobotAlone) {
  common.set(kOwn, floor_from(0.0), {});
  common.set({.session = CommonSurface::kOwnSession, .id = 2}, floor_from(0.0), {});
  EXPECT_THAT(common.take(kOwn), SizeIs(400));
  EXPECT_THAT(common.take({.session = CommonSurface::kOwnSession, .id = 2}), SizeIs(400));
}

TEST_F(CommonSurfaceTest, IsFoundWhereCorrectionsPutIt) {
  const PatchPose far_away(Pose(Eigen::Translation3d(5'000.0, 0.0, 0.0)));
  common.set(kOwn, floor_from(0.0), {});
  common.take(kOwn);
  common.set(kGuest, floor_from(0.0), far_away);
  EXPECT_THAT(common.take(kGuest), SizeIs(400));
  EXPECT_THAT(common.take_changed(10), IsEmpty());
  common.move(kGuest, {});
  const auto joined = common.take_changed(10);
  ASSERT_EQ(names(joined), Names{kGuest});
  EXPECT_THAT(joined[0].points_P, IsEmpty());
  EXPECT_THAT(common.take_changed(10), IsEmpty()) << "told once";

  const Pose turned =
      Eigen::Translation3d(0.0, 0.0, 3.0) * Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX());
  common.move(kOwn, turned);
  const auto apart = common.take_changed(10);
  ASSERT_EQ(names(apart), Names{kGuest});
  EXPECT_EQ(apart[0].points_P, floor_from(0.0));
  common.move(kGuest, turned);
  EXPECT_THAT(common.take_changed(10).at(0).points_P, IsEmpty());
}

TEST_F(CommonSurfaceTest, ComesBackWhereThisCameraHasItNoMore) {
  common.set(kOwn, floor_from(0.0), {});
  common.set(kGuest, floor_from(0.0), {});
  common.take(kGuest);
  common.set(kOwn, {}, {});
  EXPECT_THAT(common.take(kOwn), IsEmpty());
  EXPECT_THAT(common.take_changed(10).at(0).points_P, SizeIs(400));
}

TEST_F(CommonSurfaceTest, OfTwoGuestsIsThatOfTheFirst) {
  common.set(kLaterGuest, floor_from(0.0), {});
  EXPECT_THAT(common.take(kLaterGuest), SizeIs(400));
  common.set(kGuest, floor_from(0.0), {});
  EXPECT_THAT(common.take(kGuest), SizeIs(400));
  const auto changed = common.take_changed(10);
  ASSERT_EQ(names(changed), Names{kLaterGuest});
  EXPECT_THAT(changed[0].points_P, IsEmpty());
}

TEST_F(CommonSurfaceTest, ThatNoiseChangesIsToldInTheEnd) {
  common.set(kOwn, floor_from(0.002), {});
  common.set(kGuest, floor_from(0.0), {});
  EXPECT_THAT(common.take(kGuest), IsEmpty());
  std::vector<CloudPoint> fewer = floor_from(0.002);
  fewer.resize(360);  // without two rows; the first of them is less than a voxel from what is left
  common.set(kOwn, fewer, {});
  EXPECT_THAT(common.take_changed(10), IsEmpty()) << "20 of 400";
  const auto last = common.take_all_changed();
  ASSERT_EQ(names(last), Names{kGuest});
  EXPECT_THAT(last[0].points_P, SizeIs(20));
  EXPECT_THAT(common.take_all_changed(), IsEmpty());
}

TEST_F(CommonSurfaceTest, IsLookedForInTurn) {
  Names all;
  for (std::int32_t id = 0; id < 7; ++id) {
    all.push_back({.session = 8, .id = id});
    common.set(all.back(), floor_from(0.0), {});
    common.take(all.back());
  }
  common.set(kOwn, floor_from(0.0), {});
  common.take(kOwn);
  Names told;
  for (const std::size_t expected : {3U, 3U, 1U, 0U}) {
    const Names some = names(common.take_changed(3));
    EXPECT_THAT(some, SizeIs(expected));
    told.insert(told.end(), some.begin(), some.end());
  }
  std::ranges::sort(told);
  EXPECT_EQ(told, all);
}

/// Floors that are not flat, over each other.
class RandomPatches {
 public:
  explicit RandomPatches(unsigned seed) : random_(seed) {}

  struct Patch {
    Name name;
    std::vector<CloudPoint> points_P;
    PatchPose X_WP;
  };

  std::vector<Patch> patches() {
    std::vector<Patch> patches;
    std::int32_t id = 0;
    for (const std::int64_t session : {0, 8, 9}) {
      for (int i = 0; i < 5; ++i) patches.push_back({{session, id++}, points(), pose()});
    }
    return patches;
  }

  std::vector<CloudPoint> points() {
    std::vector<CloudPoint> points;
    for (int i = 0; i < 60; ++i) {
      const Eigen::Vector3d normal(0.3 * within_(random_), 0.3 * within_(random_), 1.0);
      points.push_back(
          point({0.05 * within_(random_), 0.05 * within_(random_), 0.02 * within_(random_)},
                normal.normalized()));
    }
    return seen(within_(random_) < 0.0 ? 20.0F : 40.0F, points);
  }

  PatchPose pose() {
    return Pose(Eigen::Translation3d(0.05 * within_(random_), 0.05 * within_(random_), 0.0) *
                Eigen::AngleAxisd(0.2 * within_(random_), Eigen::Vector3d::UnitX()));
  }

  std::mt19937& random() { return random_; }

 private:
  std::mt19937 random_;
  std::uniform_real_distribution<double> within_{-1.0, 1.0};
};

/// The points of a patch that no better one has.
std::vector<CloudPoint> slow_rest(const RandomPatches::Patch& patch,
                                  const std::vector<RandomPatches::Patch>& all) {
  const std::vector<CloudPoint> points_W = moved(patch.points_P, patch.X_WP);
  std::vector<CloudPoint> rest;
  for (std::size_t i = 0; i < points_W.size(); ++i) {
    const CloudPoint& p = points_W[i];
    const bool is_covered = std::ranges::any_of(all, [&](const RandomPatches::Patch& other) {
      const float weight = other.points_P[0].weight;
      const bool is_better =
          weight == p.weight ? other.name.session < patch.name.session : weight > p.weight;
      if (!is_better || other.name.session == patch.name.session) return false;
      return std::ranges::any_of(moved(other.points_P, other.X_WP), [&](const CloudPoint& q) {
        const Eigen::Vector3d apart(p.x - q.x, p.y - q.y, p.z - q.z);
        const Eigen::Vector3d normal(q.nx, q.ny, q.nz);
        const double along_m = apart.dot(normal);
        return std::abs(along_m) <= 1.5 * kVoxel_m &&
               (apart - along_m * normal).norm() <= kVoxel_m &&
               normal.dot(Eigen::Vector3d(p.nx, p.ny, p.nz)) >= std::cos(M_PI / 6);
      });
    });
    if (!is_covered) rest.push_back(patch.points_P[i]);
  }
  return rest;
}

TEST(CommonSurface, IsWhatASlowSearchFindsInWhateverOrder) {
  std::size_t num_covered = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    RandomPatches made(seed);
    std::vector<RandomPatches::Patch> patches = made.patches();
    CommonSurface common({.same = {}, .resolution_m = kVoxel_m, .keeps_own = false});
    std::map<Name, std::vector<CloudPoint>> rest;
    const auto keep = [&rest](std::vector<CommonSurface::Rest> changed) {
      for (auto& [name, points_P] : changed) rest[name] = std::move(points_P);
    };
    const auto set = [&](const RandomPatches::Patch& patch) {
      common.set(patch.name, patch.points_P, patch.X_WP);
      rest[patch.name] = common.take(patch.name);
    };
    std::ranges::shuffle(patches, made.random());
    for (const RandomPatches::Patch& patch : patches) {
      set(patch);
      if (patch.name.id % 5 == 2) keep(common.take_changed(3));
    }
    for (RandomPatches::Patch& patch : patches) {
      if (patch.name.id % 5 == 0) {
        patch.points_P = made.points();
        set(patch);
      } else if (patch.name.id % 5 == 1) {
        patch.X_WP = made.pose();
        common.move(patch.name, patch.X_WP);
      }
    }
    keep(common.take_all_changed());
    for (const RandomPatches::Patch& patch : patches) {
      EXPECT_EQ(rest.at(patch.name), slow_rest(patch, patches)) << "seed " << seed;
      num_covered += patch.points_P.size() - rest.at(patch.name).size();
    }
  }
  EXPECT_GT(num_covered, 1'000U);
}

}  // namespace
}  // namespace kintsugi::mapper
