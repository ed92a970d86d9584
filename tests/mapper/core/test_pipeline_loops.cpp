// A walk around four rooms whose beginning has left the volume when the camera comes back to it.

#include <algorithm>
#include <map>
#include <tuple>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/patch_motions.hpp"
#include "mapper/core/loop_closure/map_part.hpp"
#include "mapper/core/mapper_pipeline.hpp"
#include "segmenter/evaluation/trajectory/trajectory_error.hpp"
#include "tests/mapper/core/synthetic_frames.hpp"

namespace kintsugi::mapper {
namespace {

using testing::synthetic_run;
using testing::SyntheticRun;

constexpr int kFramesOfLap = 750;

struct Walk {
  std::vector<CloudSlice> slices;
  std::vector<CloudPoint> points_W;  ///< that left the volume, where the corrected map has them
  Trajectory online_path;
  std::map<int, Trajectory> corrected_paths;  ///< by part of the map
  Trajectory true_path;
  std::vector<int> num_keyframes;  ///< after each lap
  bool has_loop_closure = false;
  int num_loops = 0;
  int num_contradicted = 0;
  int num_parts = 0;  ///< at the end
};

struct Way {
  bool close_loops = true;
  int num_laps = 1;
  int num_frames = kFramesOfLap;         ///< of each lap
  std::pair<int, int> covered = {0, 0};  ///< from this frame to the one before that
};

Walk walk(const Way& way) {
  Walk result;
  std::vector<std::pair<std::vector<CloudPoint>, std::vector<PatchRun>>> left;
  MapperPipeline::Config config;
  config.patch_side_m = 0.25;
  config.close_loops = way.close_loops;
  config.volume.resolution_m = 0.015;
  config.volume.max_memory_mb = 8.0;  // of the rooms in view
  config.slices.on_points = [&](const auto& points, const auto& runs) {
    left.emplace_back(points, runs);
  };
  MapperPipeline pipeline(config);
  const auto take = [&](std::vector<CloudSlice> slices) {
    std::ranges::move(slices, std::back_inserter(result.slices));
  };
  for (int lap = 0; lap < way.num_laps; ++lap) {
    constexpr int kStep = 4;
    const SyntheticRun rooms =
        synthetic_run("loop", way.num_frames, true, kStep, lap * kFramesOfLap * kStep);
    std::ranges::copy(rooms.true_path, std::back_inserter(result.true_path));
    for (std::size_t i = 0; i < rooms.frames.size(); ++i) {
      const RgbdFrame& frame = rooms.frames[i];
      const bool is_covered =
          std::cmp_greater_equal(i, way.covered.first) && std::cmp_less(i, way.covered.second);
      FrameResult frame_result = pipeline.process(is_covered ? testing::blank(frame) : frame);
      take(std::move(frame_result.slices));
      result.online_path.push_back({frame.utime, frame_result.tracking.X_WC});
    }
    result.num_keyframes.push_back(pipeline.num_keyframes());
  }
  take(pipeline.finish());
  result.corrected_paths = pipeline.corrected_paths();
  result.num_parts = pipeline.num_parts();
  if (pipeline.loops() != nullptr) {
    result.has_loop_closure = true;
    result.num_loops = pipeline.loops()->num_loops();
    result.num_contradicted = pipeline.loops()->num_contradicted();
  }
  for (const auto& [points, runs] : left) {
    std::size_t first = 0;
    for (const PatchRun& run : runs) {
      const auto points_P = std::span(points).subspan(first, run.num_points);
      if (const auto place = pipeline.place_of_patch(run.patch)) {
        std::ranges::copy(moved(points_P, place->X_WP), std::back_inserter(result.points_W));
      }
      first += run.num_points;
    }
  }
  return result;
}

double error_m(const Trajectory& path, const Walk& walk) {
  return absolute_trajectory_error(path, walk.true_path).translation_m.rmse;
}

/// What a receiver of all slices has in the end.
std::vector<CloudPoint> received_points(std::vector<CloudSlice> slices) {
  std::map<std::int32_t, CloudSlice> newest;
  for (CloudSlice& slice : slices) {
    const auto known = newest.find(slice.id);
    if (known == newest.end() || known->second.revision < slice.revision) {
      newest.insert_or_assign(slice.id, std::move(slice));
    }
  }
  std::vector<CloudSlice*> pointers;
  for (auto& [id, slice] : newest) pointers.push_back(&slice);
  apply_corrections(pointers);
  std::vector<CloudPoint> points_W;
  for (const auto& [id, slice] : newest)
    std::ranges::copy(slice.points_W, std::back_inserter(points_W));
  return points_W;
}

std::vector<std::tuple<float, float, float>> sorted_positions(
    const std::vector<CloudPoint>& points) {
  std::vector<std::tuple<float, float, float>> positions;
  for (const CloudPoint& p : points) positions.emplace_back(p.x, p.y, p.z);
  std::ranges::sort(positions);
  return positions;
}

void expect_numbered_without_gaps(const std::vector<CloudSlice>& slices) {
  std::vector<bool> is_there(static_cast<std::size_t>(slices.back().id) + 1);
  for (const CloudSlice& slice : slices) is_there.at(static_cast<std::size_t>(slice.id)) = true;
  EXPECT_THAT(is_there, ::testing::Each(true));
}

void expect_closed(const Walk& walk) {
  EXPECT_GE(walk.num_loops, 2);
  EXPECT_EQ(walk.num_contradicted, 0);
  ASSERT_EQ(walk.corrected_paths.at(0).size(), walk.true_path.size());
  EXPECT_LT(error_m(walk.corrected_paths.at(0), walk), 0.6 * error_m(walk.online_path, walk));

  const auto is_correction = [](const CloudSlice& slice) {
    return slice.kind == SliceKind::kCorrection;
  };
  EXPECT_GE(std::ranges::count_if(walk.slices, is_correction), 1);
}

void expect_received(const Walk& walk) {
  EXPECT_EQ(sorted_positions(received_points(walk.slices)), sorted_positions(walk.points_W))
      << "what is written and what is received are the same, bit by bit";
  expect_numbered_without_gaps(walk.slices);
}

/// A loop brings the end of the walk to its beginning in every receiver. Where the camera walks the
/// same way again, it sees the surface that is there. One test, because a walk takes half a minute.
TEST(PipelineLoops, CorrectTheMapAndAddNothingWhenTheyAreWalkedAgain) {
  const Walk once = walk({});
  expect_closed(once);
  expect_received(once);
  const Walk twice = walk({.num_laps = 2});
  EXPECT_LT(error_m(twice.corrected_paths.at(0), twice),
            1.1 * error_m(once.corrected_paths.at(0), once));
  EXPECT_LT(twice.points_W.size(), 1.05 * once.points_W.size());
  EXPECT_GT(twice.points_W.size(), 0.95 * once.points_W.size()) << "and nothing is lost";
  EXPECT_LT(twice.num_keyframes[1], 1.1 * twice.num_keyframes[0]);
  expect_received(twice);
}

constexpr int kSixSeconds = 45;  // covered for longer than restart_after_s

/// A camera that was lost for long goes on in another part of the map. Where it comes back to the
/// first one, they become one map.
TEST(PipelineLoops, JoinThePartsOfTheMap) {
  const Walk gap = walk({.num_frames = kFramesOfLap + 90, .covered = {300, 300 + kSixSeconds}});
  EXPECT_EQ(gap.num_parts, 1);
  ASSERT_EQ(gap.corrected_paths.size(), 1U);
  const Trajectory& path = gap.corrected_paths.at(0);
  EXPECT_EQ(path.size(), gap.true_path.size() - kSixSeconds);
  EXPECT_LT(error_m(path, gap), 0.02);
  EXPECT_EQ(gap.num_contradicted, 0);

  const auto joins = [](const CloudSlice& slice) {
    return slice.kind == SliceKind::kCorrection && slice.part == 0 && !slice.motions.empty();
  };
  EXPECT_TRUE(std::ranges::any_of(gap.slices, joins));
  const auto is_far = [](const CloudPoint& point) { return std::abs(point.x) > 100.0F; };
  EXPECT_TRUE(std::ranges::none_of(gap.points_W, is_far)) << "no patch is left behind";
  expect_received(gap);
}

TEST(PipelineLoops, LeavePartsApartWhereTheCameraDoesNotComeBack) {
  const Walk gap = walk({.num_frames = 300, .covered = {150, 150 + kSixSeconds}});
  EXPECT_EQ(gap.num_parts, 2);
  ASSERT_EQ(gap.corrected_paths.size(), 2U);
  const Eigen::Vector3d middle = origin_of_part(1).translation();
  for (const StampedPose& pose : gap.corrected_paths.at(1)) {
    EXPECT_LT((pose.X_WC.translation() - middle).norm(), 100.0);
  }
  for (const CloudSlice& slice : gap.slices) {
    if (slice.kind != SliceKind::kPatch || slice.points_W.empty()) continue;
    ASSERT_EQ(slice.part, slice.points_W.front().x > 500.0F ? 1 : 0);
  }
}

TEST(PipelineLoops, AreNotLookedForWhenSwitchedOff) {
  const Walk open = walk({.close_loops = false, .num_frames = 60});
  EXPECT_FALSE(open.has_loop_closure);
  EXPECT_TRUE(walk({.num_frames = 60}).has_loop_closure);
  EXPECT_EQ(error_m(open.corrected_paths.at(0), open), error_m(open.online_path, open));
  for (const CloudSlice& slice : open.slices) {
    EXPECT_NE(slice.kind, SliceKind::kCorrection);
    EXPECT_TRUE(slice.X_WP.is_identity());
  }
}

}  // namespace
}  // namespace kintsugi::mapper
