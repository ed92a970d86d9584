// Slices and mesh of a whole run, extracted on the worker's thread.

#include <vector>

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include "mapper/core/mapper_pipeline.hpp"
#include "tests/mapper/core/synthetic_frames.hpp"

namespace kintsugi::mapper {
namespace {

using testing::synthetic_run;
using testing::SyntheticRun;

struct Map {
  std::vector<CloudSlice> slices;
  std::vector<MeshPiece> mesh;
};

/// The camera walks through the office in large steps: the small cube moves again and again.
const SyntheticRun& walk() {
  static const SyntheticRun office = synthetic_run("office", 40, true, 9);
  return office;
}

Map map_walk(std::size_t threads) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  Map map;
  MapperPipeline::Config config;
  config.volume = {
      .region = RegionShape::kCube, .volume_size_m = 3.2, .resolution_m = 0.015, .shift_vox = 8};
  config.slices.extractor.weight_threshold = 1;
  config.slices.on_mesh = [&map](const MeshPiece& piece, const std::vector<PatchRun>& /*runs*/) {
    map.mesh.push_back(piece);
  };
  config.given_path = walk().true_path;
  MapperPipeline pipeline(config);
  const auto take = [&map](std::vector<CloudSlice> slices) {
    for (CloudSlice& slice : slices) map.slices.push_back(std::move(slice));
  };
  for (const RgbdFrame& frame : walk().frames) take(pipeline.process(frame).slices);
  take(pipeline.finish());
  return map;
}

TEST(PipelineSlices, AreTheSameBytesInEachRunWithAnyNumberOfThreads) {
  const Map one = map_walk(1);
  ASSERT_GE(one.slices.size(), 5U);
  ASSERT_EQ(one.mesh.size(), one.slices.size());
  for (const std::size_t threads : {std::size_t{2}, std::size_t{2}}) {
    const Map other = map_walk(threads);
    ASSERT_EQ(other.slices.size(), one.slices.size());
    for (std::size_t i = 0; i < one.slices.size(); ++i) {
      EXPECT_EQ(other.slices[i].utime, one.slices[i].utime);
      EXPECT_EQ(other.slices[i].kind, one.slices[i].kind);
      EXPECT_EQ(other.slices[i].X_WC.matrix(), one.slices[i].X_WC.matrix());
      EXPECT_TRUE(other.slices[i].points_W == one.slices[i].points_W) << "slice " << i;
      EXPECT_TRUE(other.mesh[i].triangles == one.mesh[i].triangles) << "piece " << i;
      EXPECT_TRUE(other.mesh[i].vertices == one.mesh[i].vertices) << "piece " << i;
    }
  }
}

TEST(PipelineSlices, MakeAMeshWhoseTrianglesNameVerticesThereAre) {
  const Map map = map_walk(2);
  std::size_t num_vertices = 0;
  std::size_t num_joined = 0;
  for (const MeshPiece& piece : map.mesh) {
    const std::size_t first = num_vertices;
    num_vertices += piece.vertices.size();
    for (const MeshPiece::Triangle& triangle : piece.triangles) {
      for (const std::uint32_t vertex : triangle) {
        ASSERT_LT(vertex, num_vertices);
        if (vertex < first) ++num_joined;
      }
    }
  }
  EXPECT_GT(num_vertices, 5000U);
  EXPECT_GT(num_joined, 50U) << "pieces share vertices with those before them";
}

TEST(PipelineSlices, HoldOnlyPointsSeenMoreOftenThanTheThreshold) {
  for (const CloudSlice& slice : map_walk(2).slices) {
    for (const CloudPoint& point : slice.points_W) ASSERT_GT(point.weight, 1.0F);
  }
}

}  // namespace
}  // namespace kintsugi::mapper
