#include <gtest/gtest.h>

#include "mapper/process/run_statistics.hpp"

namespace kintsugi::mapper {
namespace {

FrameResult frame(TrackingState state, double track_ms) {
  FrameResult result;
  result.tracking.state = state;
  result.times = {.track_ms = track_ms, .integrate_ms = 2.0, .raycast_ms = 3.0};
  return result;
}

TEST(RunStatistics, CountsFramesByTheirState) {
  RunStatistics statistics;
  statistics.add(frame(TrackingState::kStarting, 1), 0);
  statistics.add(frame(TrackingState::kTracking, 1), 0);
  statistics.add(frame(TrackingState::kGiven, 1), 0);
  statistics.add(frame(TrackingState::kLost, 1), 0);
  MapperStatus status;
  statistics.report(status, 0, 0);
  EXPECT_EQ(status.frames_read, 4);
  EXPECT_EQ(status.frames_tracked, 2);
  EXPECT_EQ(status.frames_lost, 1);
  EXPECT_EQ(status.state, TrackingState::kLost);
  EXPECT_GT(status.memory_bytes, 1 << 20);
}

TEST(RunStatistics, MeansAreOverTheFramesSinceTheLastReport) {
  RunStatistics statistics;
  statistics.add(frame(TrackingState::kTracking, 100), 7);
  MapperStatus status;
  statistics.report(status, 50, 20);
  statistics.add(frame(TrackingState::kTracking, 10), 1);
  statistics.add(frame(TrackingState::kTracking, 20), 2);
  statistics.report(status, 60, 26);
  EXPECT_DOUBLE_EQ(status.track_ms, 15.0);
  EXPECT_DOUBLE_EQ(status.integrate_ms, 2.0);
  EXPECT_DOUBLE_EQ(status.raycast_ms, 3.0);
  EXPECT_DOUBLE_EQ(status.publish_ms, 1.5);
  EXPECT_DOUBLE_EQ(status.read_ms, 5.0);
  EXPECT_DOUBLE_EQ(status.extract_ms, 3.0);
  EXPECT_DOUBLE_EQ(statistics.mean_frame_ms(), (112.0 + 16.0 + 27.0) / 3.0);
}

}  // namespace
}  // namespace kintsugi::mapper
