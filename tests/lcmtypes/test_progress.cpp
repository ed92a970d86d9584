#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/tools/progress.hpp"

namespace kintsugi {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

MapperStatus mapper(std::int64_t frames_read, bool finished) {
  MapperStatus status;
  status.session = 42;
  status.state = TrackingState::kTracking;
  status.frames_read = frames_read;
  status.frames_total = 1'000;
  status.frame_rate_hz = 20.0;
  status.slices_published = 14;
  status.points_published = 1'234'567;
  status.finished = finished;
  return status;
}

SegmenterStatus segmenter(std::int64_t lag, bool finished) {
  SegmenterStatus status;
  status.session = 43;
  status.map_session = 42;
  status.slices_segmented = 14 - lag;
  status.lag_slices = lag;
  status.segments = 321;
  status.slice_mean_ms = 500.0;
  status.finished = finished;
  return status;
}

TEST(Progress, SaysInOneLineWhatAPersonWantsToKnow) {
  Progress progress;
  EXPECT_THAT(progress.line(0), HasSubstr("waiting"));
  progress.update(mapper(250, false), 0);
  EXPECT_THAT(progress.line(0), AllOf(HasSubstr("frame 250/1000 (25 %) tracking 20.0 Hz"),
                                      HasSubstr("14 slices 1.23M points"),
                                      HasSubstr("no segmenter"), HasSubstr("0:38 left")));
  progress.update(segmenter(3, false), 0);
  EXPECT_THAT(progress.line(0), HasSubstr("11 segmented, 321 segments, lag 3, 500 ms/slice"));
  EXPECT_THAT(progress.line(0), Not(HasSubstr("MISSING")));
  SegmenterStatus corrected = segmenter(0, false);
  corrected.slices_corrected = 5;
  progress.update(corrected, 0);
  EXPECT_THAT(progress.line(0), HasSubstr("14 segmented, 5 corrected, 321 segments"));
  EXPECT_THAT(progress.line(9'000'000), HasSubstr("silent for 9 s"));
}

TEST(Progress, NamesLosses) {
  Progress progress;
  MapperStatus lost = mapper(250, false);
  lost.state = TrackingState::kLost;
  lost.frames_lost = 7;
  lost.loss_reason = "too few inliers";
  progress.update(lost, 0);
  SegmenterStatus missing = segmenter(0, false);
  missing.slices_missing = 3;
  missing.chunks_missing = 5;
  missing.messages_bad = 2;
  progress.update(missing, 0);
  EXPECT_THAT(progress.line(0), AllOf(HasSubstr("LOST"), HasSubstr("(too few inliers)"),
                                      HasSubstr("7 lost"), HasSubstr("3 slices MISSING"),
                                      HasSubstr("5 chunks MISSING"), HasSubstr("2 bad messages")));
}

TEST(Progress, TimeLeftComesFromTheSlowerOfTheTwo) {
  Progress progress;
  EXPECT_FALSE(progress.time_left_s());
  progress.update(mapper(900, false), 0);
  EXPECT_DOUBLE_EQ(progress.time_left_s().value_or(-1.0), 5.0);
  progress.update(segmenter(14, false), 0);
  EXPECT_DOUBLE_EQ(progress.time_left_s().value_or(-1.0), 7.0);
  MapperStatus live = mapper(900, false);
  live.frames_total = -1;
  progress.update(live, 0);
  EXPECT_FALSE(progress.time_left_s());
}

TEST(Progress, IsFinishedWhenAllHaveSaidSoForTheSameMap) {
  Progress progress;
  progress.update(segmenter(0, true), 0);
  EXPECT_FALSE(progress.finished(false));
  progress.update(mapper(1'000, true), 0);
  EXPECT_TRUE(progress.finished(false));
  EXPECT_FALSE(progress.finished(true));
  EXPECT_EQ(progress.unfinished(true), "viewer not heard of");
  ViewerStatus viewer;
  progress.update(viewer, 0);
  EXPECT_EQ(progress.unfinished(true), "viewer not finished");
  viewer.finished = true;
  progress.update(viewer, 0);
  EXPECT_TRUE(progress.finished(true));
  EXPECT_THAT(progress.line(0), HasSubstr("finished"));

  MapperStatus next = mapper(1'000, true);
  next.session = 99;
  progress.update(next, 0);
  EXPECT_EQ(progress.unfinished(false), "segmenter finished another map");
}

TEST(Progress, MovesOnlyWhenACounterMoves) {
  Progress progress;
  EXPECT_FALSE(progress.last_progress_us());
  progress.update(mapper(1, false), 10);
  progress.update(mapper(1, false), 20);
  EXPECT_EQ(progress.last_progress_us(), 10);
  progress.update(mapper(2, false), 30);
  EXPECT_EQ(progress.last_progress_us(), 30);
}

}  // namespace
}  // namespace kintsugi
