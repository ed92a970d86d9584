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

TEST(Progress, HasTheMostImportantFieldsInOneLine) {
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

TEST(Progress, ReportsLosses) {
  Progress progress;
  MapperStatus lost = mapper(250, false);
  lost.state = TrackingState::kLost;
  lost.frames_lost = 7;
  lost.loss_reason = "too few inliers";
  progress.update(lost, 0);
  SegmenterStatus missing = segmenter(0, false);
  missing.slices_missing = 3;
  missing.chunks_missing = 9;
  missing.chunks_given_up = 5;
  missing.messages_bad = 2;
  progress.update(missing, 0);
  EXPECT_THAT(progress.line(0),
              AllOf(HasSubstr("LOST"), HasSubstr("(too few inliers)"), HasSubstr("7 lost"),
                    HasSubstr("3 slices MISSING"), HasSubstr("4 chunks asked for"),
                    HasSubstr("5 chunks MISSING"), HasSubstr("2 bad messages")));
}

TEST(Progress, TellsWhatWasRefusedOnASignedBus) {
  Progress progress;
  MapperStatus status = mapper(250, false);
  progress.update(status, 0);
  SegmenterStatus listening = segmenter(0, false);
  progress.update(listening, 0);
  EXPECT_THAT(progress.line(0), Not(HasSubstr("messages")));
  status.messages_unsigned = 3;
  listening.messages_forged = 4;
  listening.messages_replayed = 5;
  progress.update(status, 0);
  progress.update(listening, 0);
  EXPECT_THAT(progress.line(0),
              AllOf(HasSubstr("3 messages not signed"), HasSubstr("4 messages FORGED"),
                    HasSubstr("5 messages replayed")));
}

TEST(Progress, NamesThePartsUntilTheyAreJoined) {
  Progress progress;
  MapperStatus status = mapper(250, false);
  progress.update(status, 0);
  EXPECT_THAT(progress.line(0), Not(HasSubstr("part")));
  status.part = 1;
  status.parts = 2;
  progress.update(status, 0);
  EXPECT_THAT(progress.line(0), HasSubstr(", 2 parts, in part 1"));
  status.part = 0;
  status.parts = 1;
  progress.update(status, 0);
  EXPECT_THAT(progress.line(0), Not(HasSubstr("part")));
}

TEST(Progress, ReportsTheLogRestartsAndProblems) {
  Progress progress;
  MapperStatus stored = mapper(250, false);
  stored.store_bytes = 12'000'000;
  stored.chunks_resent = 17;
  progress.update(stored, 0);
  EXPECT_THAT(progress.line(0), AllOf(HasSubstr("store 12 MB, 17 resent"),
                                      Not(HasSubstr("PROBLEM")), Not(HasSubstr("restarted"))));
  stored.store_waiting_bytes = 3'000'000;
  stored.store_lost_chunks = 2;
  stored.store_problem = "cannot write 'a.lcm': No space left on device";
  progress.update(stored, 0);
  EXPECT_THAT(progress.line(0), AllOf(HasSubstr("store 12 MB (3 MB NOT ON DISK), 2 chunks LOST"),
                                      HasSubstr("PROBLEM of the mapper: cannot write 'a.lcm'")));
  SegmenterStatus again = segmenter(3, false);
  progress.update(again, 0);
  again.session += 5;
  again.queue_bytes = 45'000'000;
  progress.update(again, 0);
  again.session += 5;
  again.maps = 2;
  again.states_sent = 1;
  progress.update(again, 0);
  EXPECT_THAT(progress.line(0),
              AllOf(HasSubstr("segmenter restarted 2 times"), HasSubstr("45 MB waiting"),
                    HasSubstr("2 maps"), HasSubstr("1 full states sent"),
                    Not(HasSubstr("mapper restarted"))));
}

TEST(Progress, WatchesTheFirstMapOrTheNamedOne) {
  MapperStatus cellar = mapper(7, false);
  cellar.map_name = "cellar";
  MapperStatus room = mapper(250, false);
  room.map_name = "room";
  SegmenterStatus of_cellar = segmenter(3, false);
  of_cellar.map_name = "cellar";

  Progress first;
  Progress named("cellar");
  for (Progress* progress : {&first, &named}) {
    progress->update(room, 0);
    progress->update(cellar, 0);
    progress->update(of_cellar, 0);
  }
  EXPECT_THAT(first.line(0), AllOf(HasSubstr("frame 250"), HasSubstr("another map: cellar"),
                                   HasSubstr("no segmenter")));
  EXPECT_THAT(named.line(0), AllOf(HasSubstr("frame 7"), HasSubstr("another map: room"),
                                   HasSubstr("11 segmented")));
}

TEST(Progress, TimeLeftIsThatOfTheSlowerProcess) {
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

TEST(Progress, IsFinishedWhenAllHaveFinishedTheSameMap) {
  Progress progress;
  progress.update(segmenter(0, true), 0);
  EXPECT_FALSE(progress.finished({}));
  progress.update(mapper(1'000, true), 0);
  EXPECT_TRUE(progress.finished({}));
  EXPECT_FALSE(progress.finished({.viewer = true}));
  EXPECT_EQ(progress.unfinished({.viewer = true}), "viewer sends no status");
  ViewerStatus viewer;
  progress.update(viewer, 0);
  EXPECT_EQ(progress.unfinished({.viewer = true}), "viewer not finished");
  viewer.finished = true;
  progress.update(viewer, 0);
  EXPECT_EQ(progress.unfinished({.viewer = true}), "viewer finished another map");
  viewer.map_session = 42;
  progress.update(viewer, 0);
  EXPECT_TRUE(progress.finished({.viewer = true}));
  EXPECT_THAT(progress.line(0), HasSubstr("finished"));

  MapperStatus next = mapper(1'000, true);
  next.session = 99;
  progress.update(next, 0);
  EXPECT_EQ(progress.unfinished({}), "segmenter finished another map");
}

DetectorStatus detector(bool finished) {
  DetectorStatus status;
  status.session = 44;
  status.map_session = 42;
  status.library_objects = 40;
  status.detections_found = 2;
  status.detections_confirmed = 5;
  status.lag_p50_ms = 120.0;
  status.cpu_share = 0.07;
  status.finished = finished;
  return status;
}

TEST(Progress, ShowsTheDetectorWhereThereIsOne) {
  Progress progress;
  progress.update(mapper(1'000, true), 0);
  progress.update(segmenter(0, true), 0);
  EXPECT_THAT(progress.line(0), AllOf(Not(HasSubstr("detect")), HasSubstr("finished")));

  DetectorStatus status = detector(false);
  progress.update(status, 0);
  EXPECT_THAT(progress.line(0),
              AllOf(HasSubstr("7 detections of 40 objects (5 confirmed), lag 0, 120 ms, 7 % of a "
                              "core"),
                    Not(HasSubstr("gone")), Not(HasSubstr("REFUSED")), Not(HasSubstr("finished"))));
  status.session += 5;
  status.detections_gone = 1;
  status.candidates_waiting = 9;
  status.library_refused = 3;
  status.messages_bad = 4;
  status.problem = "objects/mug: the model is cut off";
  progress.update(status, 0);
  EXPECT_THAT(progress.line(0), AllOf(HasSubstr(", 1 gone"), HasSubstr("9 candidates waiting"),
                                      HasSubstr("3 objects REFUSED"), HasSubstr("4 bad messages"),
                                      HasSubstr("detector restarted"),
                                      HasSubstr("PROBLEM of the detector: objects/mug")));
}

TEST(Progress, WaitsForTheDetectorOnlyWhereItIsSaid) {
  Progress progress;
  progress.update(mapper(1'000, true), 0);
  progress.update(segmenter(0, true), 0);
  EXPECT_TRUE(progress.finished({}));
  EXPECT_EQ(progress.unfinished({.detector = true}), "detector sends no status");
  progress.update(detector(false), 10);
  EXPECT_TRUE(progress.finished({}));
  EXPECT_EQ(progress.unfinished({.detector = true}), "detector not finished");
  DetectorStatus examined = detector(false);
  examined.candidates_examined = 5;
  progress.update(examined, 20);
  EXPECT_EQ(progress.last_progress_us(), 20);
  progress.update(detector(true), 30);
  EXPECT_TRUE(progress.finished({.detector = true}));
}

TEST(Progress, NeedsAChangedCounterForProgress) {
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
