#include <gtest/gtest.h>

#include "mapper/process/run_statistics.hpp"

namespace kintsugi::mapper {
namespace {

TrackingResult tracked(TrackingState state) {
  TrackingResult tracking;
  tracking.state = state;
  return tracking;
}

FrameTimings timings(double track_ms, double frame_ms) {
  FrameTimings timings;
  timings.stages = {.track_ms = track_ms, .integrate_ms = 2.0, .raycast_ms = 3.0};
  timings.frame_ms = frame_ms;
  timings.cpu_ms = 2.0 * frame_ms;
  timings.publish_ms = 1.0;
  return timings;
}

TEST(RunStatistics, CountsFramesByTheirState) {
  RunStatistics statistics;
  for (const auto state : {TrackingState::kStarting, TrackingState::kTracking,
                           TrackingState::kGiven, TrackingState::kLost}) {
    statistics.add(tracked(state), true, {});
  }
  MapperStatus status;
  statistics.report(status);
  EXPECT_EQ(status.frames_read, 4);
  EXPECT_EQ(status.frames_tracked, 2);
  EXPECT_EQ(status.frames_lost, 1);
  EXPECT_EQ(status.state, TrackingState::kLost);
  EXPECT_GT(status.memory_bytes, 1 << 20);
}

TEST(RunStatistics, CountsTheFramesThatEndALoss) {
  RunStatistics statistics;
  for (const auto state : {TrackingState::kStarting, TrackingState::kTracking, TrackingState::kLost,
                           TrackingState::kLost, TrackingState::kTracking, TrackingState::kTracking,
                           TrackingState::kLost, TrackingState::kTracking}) {
    statistics.add(tracked(state), true, {});
  }
  MapperStatus status;
  statistics.report(status);
  EXPECT_EQ(status.frames_relocalised, 2);
}

TEST(RunStatistics, CountsTheLocatedFramesThatWereNotFused) {
  RunStatistics statistics;
  for (const bool is_fused : {true, false, false}) {
    statistics.add(tracked(TrackingState::kTracking), is_fused, {});
  }
  statistics.add(tracked(TrackingState::kLost), false, {});
  EXPECT_EQ(statistics.frames_tracked(), 3);
  EXPECT_EQ(statistics.frames_tracked_only(), 2);
}

TEST(RunStatistics, TellsWhyTheLastFrameIsLost) {
  RunStatistics statistics;
  TrackingResult lost = tracked(TrackingState::kLost);
  lost.loss_reason = LossReason::kLargeResidual;
  lost.quality.undetermined = 3;
  statistics.add(lost, false, {});
  MapperStatus status;
  statistics.report(status);
  EXPECT_EQ(status.loss_reason, to_string(LossReason::kLargeResidual));
  EXPECT_EQ(status.undetermined, 3);
  statistics.add(tracked(TrackingState::kTracking), true, {});
  statistics.report(status);
  EXPECT_EQ(status.loss_reason, "");
  EXPECT_EQ(status.undetermined, 0);
}

TEST(RunStatistics, MeansAreOverTheFramesSinceTheLastReport) {
  RunStatistics statistics;
  statistics.add(tracked(TrackingState::kTracking), true, timings(100, 106));
  MapperStatus status;
  statistics.report(status);
  statistics.add(tracked(TrackingState::kTracking), true, timings(10, 16));
  statistics.add(tracked(TrackingState::kTracking), true, timings(20, 26));
  statistics.report(status);
  EXPECT_DOUBLE_EQ(status.track_ms, 15.0);
  EXPECT_DOUBLE_EQ(status.integrate_ms, 2.0);
  EXPECT_DOUBLE_EQ(status.raycast_ms, 3.0);
  EXPECT_DOUBLE_EQ(status.publish_ms, 1.0);
  EXPECT_DOUBLE_EQ(status.cpu_ms, 42.0);
  EXPECT_DOUBLE_EQ(statistics.mean_frame_ms(), 148.0 / 3.0);
  EXPECT_DOUBLE_EQ(statistics.mean_cpu_ms(), 296.0 / 3.0);
}

TEST(RunStatistics, QuantilesAreThoseOfTheFramesSinceTheLastReport) {
  RunStatistics statistics;
  MapperStatus status;
  for (int ms = 200; ms > 0; --ms) {
    statistics.add(tracked(TrackingState::kTracking), true, timings(0, ms));
  }
  statistics.report(status);
  EXPECT_DOUBLE_EQ(status.frame_p50_ms, 100.0);
  EXPECT_DOUBLE_EQ(status.frame_p99_ms, 198.0);
  statistics.add(tracked(TrackingState::kTracking), true, timings(0, 7));
  statistics.report(status);
  EXPECT_DOUBLE_EQ(status.frame_p50_ms, 7.0);
  EXPECT_DOUBLE_EQ(status.frame_p99_ms, 7.0);
  statistics.report(status);  // of no frame
  EXPECT_DOUBLE_EQ(status.frame_p99_ms, 0.0);
  EXPECT_DOUBLE_EQ(status.track_ms, 0.0);
}

}  // namespace
}  // namespace kintsugi::mapper
