// The map of a run in patches, against the same run in slices.

#include <algorithm>
#include <iterator>
#include <map>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include "mapper/core/mapper_pipeline.hpp"
#include "tests/mapper/core/synthetic_frames.hpp"

namespace kintsugi::mapper {
namespace {

using testing::synthetic_run;
using testing::SyntheticRun;

/// The camera walks through the office in large steps: the small cube moves again and again.
const SyntheticRun& walk() {
  static const SyntheticRun office = synthetic_run("office", 40, true, 9);
  return office;
}

std::vector<CloudSlice> map_walk(double patch_side_m, std::size_t threads = 2) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  MapperPipeline::Config config;
  config.volume = {
      .region = RegionShape::kCube, .volume_size_m = 3.2, .resolution_m = 0.015, .shift_vox = 8};
  config.slices.extractor.weight_threshold = 1;
  config.patch_side_m = patch_side_m;
  config.given_path = walk().true_path;
  MapperPipeline pipeline(config);
  std::vector<CloudSlice> all;
  const auto take = [&all](std::vector<CloudSlice> slices) {
    std::ranges::move(slices, std::back_inserter(all));
  };
  for (const RgbdFrame& frame : walk().frames) take(pipeline.process(frame).slices);
  take(pipeline.finish());
  return all;
}

/// In an order that does not depend on the slices.
std::vector<CloudPoint> sorted(std::vector<CloudPoint> points_W) {
  const auto key = [](const CloudPoint& p) {
    return std::tuple(p.x, p.y, p.z, p.nx, p.ny, p.nz, p.red, p.green, p.blue, p.weight);
  };
  std::ranges::sort(points_W, {}, key);
  return points_W;
}

std::vector<CloudPoint> points_of(const std::vector<CloudSlice>& slices) {
  std::vector<CloudPoint> points_W;
  for (const CloudSlice& slice : slices) {
    points_W.insert(points_W.end(), slice.points_W.begin(), slice.points_W.end());
  }
  return points_W;
}

std::vector<CloudSlice> newest_of(const std::vector<CloudSlice>& patches) {
  std::map<std::int32_t, CloudSlice> newest;
  for (const CloudSlice& patch : patches) newest[patch.id] = patch;
  std::vector<CloudSlice> slices;
  for (const auto& [id, patch] : newest) slices.push_back(patch);
  return slices;
}

TEST(PipelinePatches, HaveInTheirLastRevisionsThePointsOfTheSlices) {
  const auto patches = map_walk(0.5);
  const auto last = points_of(newest_of(patches));
  EXPECT_GT(last.size(), 20'000U);
  EXPECT_TRUE(sorted(last) == sorted(points_of(map_walk(0.0))));
}

TEST(PipelinePatches, AreSentDuringTheRunAndNeverTwiceInOneRevision) {
  const auto patches = map_walk(0.5);
  std::map<std::int32_t, std::int32_t> revisions;
  std::int32_t next_id = 0;
  std::int64_t revision_sum = 0;
  std::size_t num_in_volume = 0;
  for (const CloudSlice& patch : patches) {
    if (!revisions.contains(patch.id)) {
      EXPECT_EQ(patch.id, next_id++);
      EXPECT_EQ(patch.revision, 0);
    } else {
      EXPECT_EQ(patch.revision, revisions[patch.id] + 1);
      ++revision_sum;
    }
    revisions[patch.id] = patch.revision;
    num_in_volume += patch.in_volume ? 1 : 0;
  }
  EXPECT_GT(num_in_volume, 50U);
  EXPECT_EQ(patches.back().kind, SliceKind::kFinal);
  EXPECT_EQ(patches.back().revision_sum, revision_sum);
  for (const CloudSlice& patch : newest_of(patches)) EXPECT_FALSE(patch.in_volume) << patch.id;
}

TEST(PipelinePatches, ComeInBatchesOfOneTime) {
  const auto patches = map_walk(0.5);
  for (std::size_t i = 1; i < patches.size(); ++i) {
    const bool same_time = patches[i].utime == patches[i - 1].utime;
    const bool same_state = patches[i].in_volume == patches[i - 1].in_volume;
    if (patches[i - 1].ends_batch) continue;
    EXPECT_TRUE(same_time) << i << ' ' << same_state;
  }
  EXPECT_TRUE(patches[patches.size() - 2].ends_batch);
}

TEST(PipelinePatches, AreTheSameBytesInEachRunWithAnyNumberOfThreads) {
  const auto one = map_walk(0.5, 1);
  const auto two = map_walk(0.5, 2);
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].id, two[i].id);
    EXPECT_EQ(one[i].revision, two[i].revision);
    EXPECT_EQ(one[i].utime, two[i].utime);
    EXPECT_TRUE(one[i].points_W == two[i].points_W) << i;
  }
}

}  // namespace
}  // namespace kintsugi::mapper
