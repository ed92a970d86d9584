#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/core/slices/patch_schedule.hpp"
#include "tests/mapper/core/exact_volume.hpp"

namespace kintsugi::mapper {
namespace {

using ::testing::Each;
using ::testing::Field;
using ::testing::SizeIs;

/// The plane z = height in a volume that is seen whole at each frame, 0.1 s apart.
class SchedulePlane : public ::testing::Test {
 protected:
  SchedulePlane() { set_plane(0.303, 20); }

  void set_plane(double height_m, int weight) {
    testing::set_exact_distances(volume_, weight,
                                 [&](const Eigen::Vector3d& p_W) { return p_W.z() - height_m; });
  }
  /// A second surface, a square of `side` voxels 6 cm above the plane, in the middle of a patch.
  void add_box(int side) {
    testing::set_exact_distances(volume_, 20, [&](const Eigen::Vector3d& p_W) {
      const Eigen::Vector2d from_middle = p_W.head<2>().array() - 0.24;
      const bool is_above = from_middle.cwiseAbs().maxCoeff() < 0.005 * side && p_W.z() > 0.333;
      return is_above ? p_W.z() - 0.363 : p_W.z() - 0.303;
    });
  }
  std::optional<PatchBatch> frame(int keyframe = 0) {
    volume_.shift_to(Eigen::Vector3d::Zero());
    for (BlockSlot slot = 0; slot < volume_.slots_end(); ++slot) {
      if (volume_.in_use(slot)) volume_.mark_seen(slot);
    }
    utime_ += 100'000;
    return schedule_.next(volume_, utime_, keyframe);
  }
  /// The number of frames until the next batch; 0: none in 200 frames.
  int frames_until_batch() {
    for (int i = 1; i <= 200; ++i) {
      batch_ = frame();
      if (batch_) return i;
    }
    return 0;
  }

  TsdfVolume volume_ = testing::exact_volume(
      2.0, 0.01, 20, [](const Eigen::Vector3d& p_W) { return p_W.z() - 0.303; });
  TileGrid grid_{0.5, 0.01};
  CrossingRule rule_{8, 4.0, volume_.resolution_m(), volume_.max_truncation_m()};
  PatchSchedule schedule_{{}, grid_, rule_};
  std::int64_t utime_ = 1'000'000;
  std::optional<PatchBatch> batch_;
};

TEST_F(SchedulePlane, SendsWhatIsAllNewAfterTwoTenthsOfASecond) {
  EXPECT_EQ(frames_until_batch(), 3) << "the clock starts at the first frame";
  EXPECT_THAT(batch_->patches, SizeIs(::testing::Ge(16U)));
  EXPECT_THAT(batch_->patches, Each(Field(&PatchBatch::Patch::in_volume, true)));
  EXPECT_TRUE(std::ranges::is_sorted(batch_->patches, {}, &PatchBatch::Patch::tile));
}

TEST_F(SchedulePlane, SendsNothingThatDoesNotChange) {
  frames_until_batch();
  EXPECT_EQ(frames_until_batch(), 0);
  set_plane(0.304, 25);
  EXPECT_EQ(frames_until_batch(), 0) << "a tenth of a voxel, and a few observations";
}

TEST_F(SchedulePlane, DoesNotSendAgainWhatCameBackAsItWas) {
  frames_until_batch();
  const std::size_t num_tiles = batch_->patches.size();
  const PatchBatch departed = schedule_.depart_all({});
  EXPECT_EQ(departed.patches.size(), num_tiles);
  EXPECT_THAT(departed.patches, Each(Field(&PatchBatch::Patch::in_volume, false)));
  for (const PatchBatch::Patch& patch : departed.patches) {
    schedule_.note_returned(patch.tile, 7, volume_);
  }
  EXPECT_EQ(frames_until_batch(), 0);
  set_plane(0.353, 40);
  EXPECT_LE(frames_until_batch(), 2) << "but when it changes";
}

TEST_F(SchedulePlane, EndsAllVisitsAndThoseThatItDoesNotKnow) {
  frames_until_batch();
  const TileCoord unknown{.z = 50, .y = 0, .x = 0};
  const PatchBatch departed = schedule_.depart_all({unknown});
  EXPECT_EQ(departed.patches.size(), batch_->patches.size() + 1);
  EXPECT_EQ(departed.patches.back().tile, unknown);
  EXPECT_THAT(schedule_.depart_all({}).patches, SizeIs(0U));
}

TEST_F(SchedulePlane, SendsBetterSurfaceLaterThanNewSurface) {
  frames_until_batch();
  set_plane(0.303, 40);
  const int better = frames_until_batch();
  EXPECT_GE(better, 98);
  EXPECT_LE(better, 104);
  set_plane(0.353, 40);
  EXPECT_LE(frames_until_batch(), 2);
}

// Of a patch of 48 x 48 voxels.
TEST_F(SchedulePlane, SendsASmallPartThatIsNewWithinALimitAndNoiseNever) {
  frames_until_batch();
  add_box(6);
  EXPECT_EQ(frames_until_batch(), 0) << "36 voxels are fewer than the root of 2,304";
  add_box(8);
  const int part = frames_until_batch();
  EXPECT_GE(part, 6) << "64 voxels are 3 %: they would wait for 5 s";
  EXPECT_LE(part, 7);
  EXPECT_THAT(batch_->patches, SizeIs(1));
}

TEST_F(SchedulePlane, SendsAPatchALastTimeWhenItsTileHasLeft) {
  frames_until_batch();
  const std::size_t num_patches = batch_->patches.size();
  for (const DetachedBlocks& left : volume_.shift_to({10.0, 0.0, 0.0})) {
    schedule_.note_left(left.coords, volume_);
  }
  utime_ += 200'000;
  const auto batch = schedule_.next(volume_, utime_);
  ASSERT_TRUE(batch);
  EXPECT_THAT(batch->patches, SizeIs(::testing::Ge(num_patches)));
  EXPECT_THAT(batch->patches, Each(Field(&PatchBatch::Patch::in_volume, false)));
  utime_ += 200'000;
  EXPECT_FALSE(schedule_.next(volume_, utime_));
}

TEST_F(SchedulePlane, TellsWhereATileWithoutSurfaceWasSeen) {
  const int seen_at = 3;
  const int later = 8;
  set_plane(0.303, 4);  // too few observations
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(frame(seen_at));
  volume_.shift_to(Eigen::Vector3d::Zero());  // nothing is seen
  utime_ += 200'000;
  EXPECT_FALSE(schedule_.next(volume_, utime_, later));
  for (const DetachedBlocks& left : volume_.shift_to({10.0, 0.0, 0.0})) {
    schedule_.note_left(left.coords, volume_);
  }
  utime_ += 200'000;
  const auto batch = schedule_.next(volume_, utime_, later);
  ASSERT_TRUE(batch);
  EXPECT_THAT(batch->patches, Each(Field(&PatchBatch::Patch::keyframe, seen_at)));
}

TEST(PatchScheduleConfig, RefusesTimesThatAreNone) {
  const TileGrid grid(0.5, 0.01);
  const CrossingRule rule(8, 4.0, 0.01, 0.04);
  EXPECT_THROW(PatchSchedule({.new_surface_s = 0.0}, grid, rule), std::invalid_argument);
  EXPECT_THROW(PatchSchedule({.period_s = -1.0}, grid, rule), std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi::mapper
