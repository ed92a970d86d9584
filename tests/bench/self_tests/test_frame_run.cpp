#include <cmath>
#include <sstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/bench/frame_run.hpp"
#include "tests/bench/frame_table.hpp"
#include "tests/bench/frame_threads.hpp"

namespace kintsugi::mapper::bench {
namespace {

using ::testing::HasSubstr;

TEST(Percentile, IsTheSmallestValueThatTheShareDoesNotExceed) {
  EXPECT_EQ(percentile({3, 1, 2}, 0.5), 2.0);
  EXPECT_EQ(percentile({4, 1, 2, 3}, 0.5), 2.0);
  EXPECT_EQ(percentile({5}, 0.99), 5.0);
  std::vector<double> hundred;
  for (int i = 1; i <= 100; ++i) hundred.push_back(i);
  EXPECT_EQ(percentile(hundred, 0.99), 99.0);
  EXPECT_EQ(percentile(hundred, 0.0), 1.0);
  EXPECT_TRUE(std::isnan(percentile({}, 0.5)));
}

TEST(StageTable, HasAMedianA99thPercentileAndAMeanForEachRun) {
  FrameRun run;
  run.config.threads = 1;
  for (const double ms : {1.0, 2.0, 6.0}) {
    FrameSample sample;
    sample.stages.track_ms = ms;
    sample.stages_cpu.track_ms = 2.0 * ms;
    sample.slice_left = ms == 2.0;
    sample.frame_ms = 10.0 * ms;
    run.samples.push_back(sample);
  }
  run.slice_worker_cpu_ms = 0.25;
  std::ostringstream out;
  print_stage_table(out, {run, run});
  EXPECT_THAT(out.str(), HasSubstr("| 8.8 mm, 1 thread | 8.8 mm, 1 thread |\n|---|---|---|\n"));
  EXPECT_THAT(out.str(), HasSubstr("| track | 2.00 / 6.00 / 6.00 | 2.00 / 6.00 / 6.00 |\n"));
  EXPECT_THAT(out.str(), HasSubstr("| frame after which a slice left | 20.0 / 20.0 / 0.00 |"));
  EXPECT_THAT(out.str(), HasSubstr("slice worker | - / - / 0.25 |"));
}

TEST(Threads, HaveTheirOwnCpuTime) {
#ifdef __SANITIZE_THREAD__
  GTEST_SKIP() << "the thread sanitizer has a thread of its own";
#endif
  const Threads before = current_threads();
  double mine_ms = 0.0;
  double others_ms = 0.0;
  std::thread([&] {
    const Threads mine = new_threads(current_threads(), before);
    ASSERT_EQ(mine.size(), 1U);
    const double start_ms = cpu_ms(mine);
    const double others_start_ms = cpu_ms(before);
    while (cpu_ms(mine) < start_ms + 5.0) {
    }
    mine_ms = cpu_ms(mine) - start_ms;
    others_ms = cpu_ms(before) - others_start_ms;
  }).join();
  EXPECT_GE(mine_ms, 5.0);
  EXPECT_LT(others_ms, 2.5) << "the main thread waits meanwhile";
}

TEST(FrameRun, TimesEachFrameAfterTheWarmUp) {
  FrameRunConfig config;
  config.device = "synthetic://box-room?frames=7";
  config.frames = 4;
  config.warm_up_frames = 3;
  config.device_rests = true;
  config.pipeline.volume = {
      .region = RegionShape::kCube, .volume_size_m = 8.0, .resolution_m = 0.02};  // the whole room
  const FrameRun run = run_frames(config);
  ASSERT_EQ(run.samples.size(), 4U);
  EXPECT_EQ(run.frames_lost, 0);
  for (const FrameSample& sample : run.samples) {
    EXPECT_GT(sample.convert_ms, 0.0);
    EXPECT_GT(sample.stages.raycast_ms, 0.0);
    EXPECT_GE(sample.frame_ms, sample.read_ms + sample.convert_ms + sample.stages.total_ms());
  }
  EXPECT_GT(run.blocks, 0);
}

}  // namespace
}  // namespace kintsugi::mapper::bench
