#include <algorithm>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "mapper/core/extraction/surface_extractor.hpp"
#include "mapper/core/reactivation/reactivation.hpp"
#include "tests/mapper/core/exact_volume.hpp"

namespace kintsugi::mapper {
namespace {

constexpr double kVoxel_m = 0.01;
constexpr double kFloor_m = 0.103;
constexpr std::int64_t kLong_us = 60'000'000;

TsdfVolume floor_of(double size_m) {
  return testing::exact_volume(size_m, kVoxel_m, 20,
                               [](const Eigen::Vector3d& p_U) { return p_U.z() - kFloor_m; });
}

/// A small floor that was seen at keyframe 0, and a larger one at keyframe 1, which sees the
/// small one where it is.
class TwoFloors : public ::testing::Test {
 protected:
  TwoFloors() {
    TsdfVolume small = floor_of(0.5);
    places_ = coords_of(small);
    num_small_ = num_points(small.snapshot());
    leave(small.detach_all(SliceKind::kPatch), 0);
    close_all(0);
  }

  std::vector<BlockCoord> coords_of(TsdfVolume& volume) { return volume.snapshot().coords; }
  std::size_t num_points(const DetachedBlocks& blocks) const {
    return SurfaceExtractor({}).extract_blocks(blocks).points_W.size();
  }
  static std::optional<Pose> first_is_far(int keyframe) {
    return keyframe == 0 ? std::optional<Pose>(Pose::Identity()) : std::nullopt;
  }
  DetachedBlocks leave(DetachedBlocks left, std::int64_t utime) {
    const Reactivation::SeenBlocks seen = {left.coords, first_is_far};
    return reactivation_.keep_unknown(std::move(left), large_.config(), {seen}, {}, utime).get();
  }
  void close_all(int keyframe) {
    PatchBatch batch;
    for (const TileCoord& tile : reactivation_.open_tiles()) {
      batch.patches.push_back({tile, false, keyframe});
    }
    reactivation_.close_departed(batch);
  }
  bool has_most_of(const std::vector<BlockCoord>& places, int near) {
    return reactivation_.has_most_of(places, {near == 0, near == 1});
  }

  TsdfVolume large_ = floor_of(1.0);
  std::vector<BlockCoord> places_;  ///< of the small floor
  std::size_t num_small_ = 0;       ///< points
  Reactivation reactivation_{TileGrid(0.16, kVoxel_m), 100.0};
};

TEST_F(TwoFloors, KeepTheFirstAndWhatOnlyTheSecondHas) {
  const std::size_t num_all = num_points(large_.snapshot());
  const DetachedBlocks rest = leave(large_.detach_all(SliceKind::kPatch), 0);
  close_all(1);
  EXPECT_LT(num_points(rest), num_all - num_small_ / 2);
  EXPECT_GT(num_points(rest), num_all - num_small_ - 1) << "more at the edge of the small one";
  EXPECT_TRUE(has_most_of(rest.coords, 1));
  EXPECT_TRUE(has_most_of(places_, 0));
}

/// As clear_known() does it in the volume.
TEST_F(TwoFloors, LoseTheSameInTheVolumeAndOnTheWayOut) {
  TsdfVolume volume = floor_of(1.0);
  reactivation_.clear_known(volume, {{coords_of(volume), first_is_far}}, {});
  const DetachedBlocks expected = volume.detach_all(SliceKind::kPatch);

  const DetachedBlocks rest = leave(large_.detach_all(SliceKind::kPatch), 0);
  ASSERT_EQ(rest.coords, expected.coords);
  for (std::size_t i = 0; i < rest.coords.size(); ++i) {
    ASSERT_EQ(rest.voxels[i]->voxels, expected.voxels[i]->voxels);
    ASSERT_EQ(rest.colors[i]->colors, expected.colors[i]->colors);
  }
}

TEST_F(TwoFloors, CountWhatIsKeptAtATimeThatNoThreadDecides) {
  reactivation_.tidy(kLong_us);
  const std::size_t before = reactivation_.bytes();
  EXPECT_GT(before, 0U);
  leave(large_.detach_all(SliceKind::kPatch), kLong_us);
  close_all(1);
  reactivation_.tidy(kLong_us + 1'000'000);
  EXPECT_EQ(reactivation_.bytes(), before) << "although it is there already";
  reactivation_.tidy(2 * kLong_us);
  EXPECT_GT(reactivation_.bytes(), before);
}

/// The left half was seen at another keyframe, from which the first one is 5 cm higher.
TEST_F(TwoFloors, AreComparedWhereEachBlockWasSeen) {
  TsdfVolume volume = floor_of(1.0);
  Reactivation::SeenBlocks left{{}, [](int /*keyframe*/) {
                                  Pose X_OU = Pose::Identity();
                                  X_OU.translation().z() = -0.05;
                                  return X_OU;
                                }};
  Reactivation::SeenBlocks right{{}, first_is_far};
  for (const BlockCoord& coord : coords_of(volume)) {
    (coord.x < 0 ? left : right).coords.push_back(coord);
  }
  const auto num_on_left = [&] {
    return std::ranges::count_if(SurfaceExtractor({}).extract_blocks(volume.snapshot()).points_W,
                                 [](const CloudPoint& point) { return point.x < 0.0F; });
  };
  const auto num_before = static_cast<std::int64_t>(num_points(volume.snapshot()));
  const auto num_on_left_before = num_on_left();
  reactivation_.clear_known(volume, {left, right}, {});
  EXPECT_EQ(num_on_left(), num_on_left_before);
  EXPECT_LT(static_cast<std::int64_t>(num_points(volume.snapshot())),
            num_before - static_cast<std::int64_t>(num_small_) / 3);
}

/// A third floor leaves before the second one is kept.
TEST_F(TwoFloors, AreComparedWithWhatWaits) {
  const std::vector<BlockCoord> all = coords_of(large_);
  TsdfVolume third = floor_of(1.0);
  const std::size_t num_all = num_points(third.snapshot());
  leave(large_.detach_all(SliceKind::kPatch), 0);
  close_all(1);
  reactivation_.clear_known(third, {{all, [](int /*keyframe*/) { return Pose::Identity(); }}}, {});
  EXPECT_LT(num_points(third.snapshot()), num_all / 20) << "where two of the others meet";
}

/// The volume has blocks in all tiles of the small floor.
TEST_F(TwoFloors, ComeBackWhereTheVolumeHasNoSurface) {
  const Intrinsics camera{
      .fx = 160, .fy = 160, .cx = 79.5, .cy = 59.5, .width = 160, .height = 120};
  SurfaceMap seen_C(camera);
  const double height_m = 0.5;
  seen_C.depth_m.setTo(static_cast<float>(height_m));
  Pose X_UC(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()));  // looks down
  X_UC.translation().z() = kFloor_m + height_m;
  const auto take = [&](bool has_surface) {
    return reactivation_.take_visible(seen_C, X_UC, {true}, 0, large_,
                                      [&](const TileCoord& /*tile*/) { return has_surface; });
  };
  EXPECT_TRUE(take(true).blocks.empty());
  EXPECT_GT(take(false).blocks.size(), places_.size() / 2) << "those in view";
  EXPECT_TRUE(take(false).blocks.empty()) << "they are no longer kept";
}

/// The small floor did not come back, because the volume had surface in its tiles by then.
TEST_F(TwoFloors, OfNearKeyframesStayOnceInTheSameTiles) {
  const std::size_t num_all = num_points(large_.snapshot());
  const auto is_near = [](int /*keyframe*/) { return std::optional<Pose>(); };
  const std::vector<Reactivation::SeenBlocks> seen = {{coords_of(large_), is_near}};
  const DetachedBlocks rest =
      reactivation_.keep_unknown(large_.detach_all(SliceKind::kPatch), large_.config(), seen, {}, 0)
          .get();
  EXPECT_LT(num_points(rest), num_all - num_small_ / 2);
  EXPECT_GT(num_points(rest), num_all - num_small_ - 1) << "more at the edge of the small one";
}

}  // namespace
}  // namespace kintsugi::mapper
