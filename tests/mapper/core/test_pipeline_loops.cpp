// A walk around four rooms whose beginning has left the volume when the camera comes back to it.

#include <algorithm>
#include <map>
#include <tuple>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/patch_motions.hpp"
#include "mapper/core/mapper_pipeline.hpp"
#include "segmenter/evaluation/trajectory/trajectory_error.hpp"
#include "tests/mapper/core/synthetic_frames.hpp"

namespace kintsugi::mapper {
namespace {

using testing::synthetic_run;
using testing::SyntheticRun;

struct Walk {
  std::vector<CloudSlice> slices;
  std::vector<CloudPoint> points_W;  ///< that left the volume, where the corrected map has them
  Trajectory online_path;
  Trajectory corrected_path;
  int num_loops = 0;
  int num_contradicted = 0;
};

const SyntheticRun& rooms() {
  static const SyntheticRun run = synthetic_run("loop", 750, true, 4);
  return run;
}

Walk walk(bool close_loops) {
  Walk result;
  std::vector<std::pair<std::vector<CloudPoint>, std::vector<PatchRun>>> left;
  MapperPipeline::Config config;
  config.patch_side_m = 0.25;
  config.close_loops = close_loops;
  config.volume.resolution_m = 0.015;
  config.volume.max_memory_mb = 8.0;  // of the rooms in view
  config.slices.on_points = [&](const auto& points, const auto& runs) {
    left.emplace_back(points, runs);
  };
  MapperPipeline pipeline(config);
  const auto take = [&](std::vector<CloudSlice> slices) {
    std::ranges::move(slices, std::back_inserter(result.slices));
  };
  for (const RgbdFrame& frame : rooms().frames) {
    FrameResult frame_result = pipeline.process(frame);
    take(std::move(frame_result.slices));
    result.online_path.push_back({frame.utime, frame_result.tracking.X_WC});
  }
  take(pipeline.finish());
  result.corrected_path = pipeline.corrected_path();
  if (pipeline.loops() != nullptr) {
    result.num_loops = pipeline.loops()->num_loops();
    result.num_contradicted = pipeline.loops()->num_contradicted();
  }
  for (const auto& [points, runs] : left) {
    std::size_t first = 0;
    for (const PatchRun& run : runs) {
      const auto points_P = std::span(points).subspan(first, run.num_points);
      std::ranges::copy(moved(points_P, pipeline.pose_of_patch(run.patch)),
                        std::back_inserter(result.points_W));
      first += run.num_points;
    }
  }
  return result;
}

double error_m(const Trajectory& path) {
  return absolute_trajectory_error(path, rooms().true_path).translation_m.rmse;
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

/// One test, because the walk takes some seconds.
TEST(PipelineLoops, BringTheEndOfTheWalkToItsBeginningInEveryReceiver) {
  const Walk closed = walk(true);
  EXPECT_GE(closed.num_loops, 2);
  EXPECT_EQ(closed.num_contradicted, 0);
  ASSERT_EQ(closed.corrected_path.size(), rooms().frames.size());
  EXPECT_LT(error_m(closed.corrected_path), 0.6 * error_m(closed.online_path));

  const auto is_correction = [](const CloudSlice& slice) {
    return slice.kind == SliceKind::kCorrection;
  };
  EXPECT_GE(std::ranges::count_if(closed.slices, is_correction), 1);
  EXPECT_EQ(sorted_positions(received_points(closed.slices)), sorted_positions(closed.points_W))
      << "what is written and what is received are the same, bit by bit";
  expect_numbered_without_gaps(closed.slices);
}

TEST(PipelineLoops, AreNotClosedWhenSwitchedOff) {
  const Walk open = walk(false);
  EXPECT_EQ(open.num_loops, 0);
  EXPECT_EQ(error_m(open.corrected_path), error_m(open.online_path));
  for (const CloudSlice& slice : open.slices) {
    EXPECT_NE(slice.kind, SliceKind::kCorrection);
    EXPECT_TRUE(slice.X_WP.is_identity());
  }
}

}  // namespace
}  // namespace kintsugi::mapper
