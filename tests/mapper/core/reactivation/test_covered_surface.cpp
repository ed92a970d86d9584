#include <algorithm>
#include <memory>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "mapper/core/extraction/surface_extractor.hpp"
#include "mapper/core/reactivation/covered_surface.hpp"
#include "tests/mapper/core/exact_volume.hpp"

namespace kintsugi::mapper {
namespace {

constexpr double kVoxel_m = 0.01;

template <typename Function>
TsdfVolume volume_of(Function signed_distance_m, int weight = 20) {
  return testing::exact_volume(1.0, kVoxel_m, weight, signed_distance_m);
}

std::vector<BlockSlot> slots_of(const TsdfVolume& volume) {
  std::vector<BlockSlot> slots;
  for (BlockSlot slot = 0; slot < volume.slots_end(); ++slot) {
    if (volume.in_use(slot)) slots.push_back(slot);
  }
  return slots;
}

/// A floor, seen from above.
constexpr double kFloor_m = 0.103;
double above_floor(const Eigen::Vector3d& p_U) { return p_U.z() - kFloor_m; }

class Floor : public ::testing::Test {
 protected:
  /// Covers the floor with a plane in frame O.
  template <typename Function>
  void clear(Function signed_distance_m, const Pose& X_OU, int weight = 20) {
    clear(volume_of(signed_distance_m, weight), X_OU, false);
  }
  void clear(const TsdfVolume& other, const Pose& X_OU, bool is_in_place) {
    auto blocks = std::make_shared<std::vector<StoredBlock>>();
    for (const BlockSlot slot : slots_of(other)) {
      blocks->push_back({other.coord(slot), other.voxels(slot), other.colors(slot)});
    }
    std::ranges::sort(*blocks, {}, &StoredBlock::coord);
    const Cover cover{.X_OU = X_OU,
                      .center_U = Eigen::Vector3d::Zero(),
                      .radius_m = 2.0,
                      .blocks = std::move(blocks),
                      .is_in_place = is_in_place};
    clear_covered(floor_, {{floor_.snapshot().coords, {cover}}}, {});
  }
  std::vector<CloudPoint> points() {
    return SurfaceExtractor({}).extract_blocks(floor_.snapshot()).points_W;
  }

  TsdfVolume floor_ = volume_of(above_floor);
};

TEST_F(Floor, IsClearedWhereTheSameSurfaceIs) {
  ASSERT_FALSE(points().empty());
  clear(above_floor, Pose::Identity());
  EXPECT_TRUE(points().empty());
}

TEST_F(Floor, IsClearedByASurfaceAVoxelAwayInAnotherFrame) {
  Pose X_OU = Pose::Identity();
  X_OU.linear() = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX()).toRotationMatrix();
  X_OU.translation() = Eigen::Vector3d(0.02, -0.03, 0.015);
  const Pose X_UO = X_OU.inverse();
  const auto in_o = [&](const Eigen::Vector3d& p_O) { return above_floor(X_UO * p_O) - kVoxel_m; };
  const std::size_t before = points().size();
  clear(in_o, X_OU);
  // The other volume is a cube, too, which is turned.
  EXPECT_LT(points().size(), before / 4);
  for (const CloudPoint& point : points()) {
    EXPECT_GT(std::max(std::abs(point.y), std::abs(point.x)), 0.35F) << "only at the edges";
  }
}

TEST_F(Floor, StaysWhereTheOtherSurfaceIsFartherAway) {
  const std::size_t before = points().size();
  clear([](const Eigen::Vector3d& p) { return above_floor(p) - 2.0 * kVoxel_m; }, Pose::Identity());
  EXPECT_EQ(points().size(), before);
}

TEST_F(Floor, StaysWhereTheOtherSurfaceFacesElsewhere) {
  const std::size_t before = points().size();
  clear([](const Eigen::Vector3d& p) { return -above_floor(p); }, Pose::Identity());
  EXPECT_EQ(points().size(), before) << "the ceiling of the floor below";
  const double tilt = 40.0 * std::numbers::pi / 180.0;
  clear(
      [&](const Eigen::Vector3d& p) {
        return std::cos(tilt) * above_floor(p) + std::sin(tilt) * p.x();
      },
      Pose::Identity());
  EXPECT_EQ(points().size(), before) << "a ramp";
}

/// 40 degrees, whose axis is on the floor at x = 0: within a voxel and a half there.
TEST_F(Floor, IsClearedByARampInPlaceButNotByAWallOrTheOtherSide) {
  const std::size_t before = points().size();
  clear(volume_of([](const Eigen::Vector3d& p) { return p.x(); }), Pose::Identity(), true);
  EXPECT_EQ(points().size(), before);
  clear(volume_of([](const Eigen::Vector3d& p) { return -above_floor(p); }), Pose::Identity(),
        true);
  EXPECT_EQ(points().size(), before);
  const double tilt = 40.0 * std::numbers::pi / 180.0;
  clear(volume_of([&](const Eigen::Vector3d& p) {
          return std::cos(tilt) * above_floor(p) + std::sin(tilt) * p.x();
        }),
        Pose::Identity(), true);
  const auto left = points();
  EXPECT_LT(left.size(), before);
  EXPECT_GT(left.size(), before * 9 / 10);
  for (const CloudPoint& point : left) EXPECT_GT(std::abs(point.x), 1.0 * kVoxel_m);
}

/// Of each pair of columns of voxels one was hardly seen, as where a surface ends.
TEST_F(Floor, IsClearedWhereTheSurfaceEndsByTheSameSurface) {
  const auto hardly_see = [](TsdfVolume& volume) {
    for (const BlockSlot slot : slots_of(volume)) {
      for (int i = 1; i < kBlockVoxels; i += 2) {
        Voxel& voxel = volume.voxels(slot).voxels[i];
        voxel = static_cast<Voxel>(5) << 16 | (voxel & 0xffff);
      }
    }
  };
  TsdfVolume other = volume_of(above_floor);
  hardly_see(other);
  hardly_see(floor_);
  ASSERT_FALSE(points().empty());
  clear(other, Pose::Identity(), false);
  EXPECT_TRUE(points().empty());
}

TEST_F(Floor, StaysWhereTheOtherSurfaceWasHardlySeen) {
  const std::size_t before = points().size();
  clear(above_floor, Pose::Identity(), 5);
  EXPECT_EQ(points().size(), before);
}

/// A floor whose distances are off by up to 0.4 voxels. Between two of them the normals of every
/// tenth voxel differ by more than 30 degrees.
auto noisy_above_floor(unsigned seed) {
  return [random = std::mt19937(seed)](const Eigen::Vector3d& p_U) mutable {
    return above_floor(p_U) + std::uniform_real_distribution(-0.4, 0.4)(random) * kVoxel_m;
  };
}

TEST_F(Floor, LeavesNoSpecksOfNoise) {
  floor_ = volume_of(noisy_above_floor(1));
  ASSERT_FALSE(points().empty());
  clear(noisy_above_floor(2), Pose::Identity());
  for (const CloudPoint& point : points()) {
    EXPECT_GT(std::max(std::abs(point.x), std::abs(point.y)), 0.47F)
        << "only at the edges, where normals are taken from one side";
  }
}

TEST_F(Floor, OfNoiseStaysBesideTheOtherSurface) {
  floor_ = volume_of(noisy_above_floor(1));
  const auto before = points();
  Pose half_a_metre = Pose::Identity();
  half_a_metre.translation().x() = -0.5;
  clear(noisy_above_floor(2), half_a_metre);
  const auto is_beside = [](const CloudPoint& point) { return point.x < -0.08F; };
  EXPECT_EQ(std::ranges::count_if(points(), is_beside), std::ranges::count_if(before, is_beside));
  for (const CloudPoint& point : points()) EXPECT_LT(point.x, 0.08F);
}

TEST_F(Floor, StaysBesideTheOtherSurface) {
  Pose half_a_metre = Pose::Identity();
  half_a_metre.translation().x() = -0.5;  // what is at x in U is at x - 0.5 in O
  clear(above_floor, half_a_metre);
  const auto left = points();
  EXPECT_FALSE(left.empty());
  for (const CloudPoint& point : left)
    EXPECT_LT(point.x, 0.08F) << "the cubes end with whole blocks";
  const auto max = std::ranges::max(left, {}, &CloudPoint::x);
  EXPECT_GT(max.x, -0.08F) << "no gap but the ends of the cubes";
}

}  // namespace
}  // namespace kintsugi::mapper
