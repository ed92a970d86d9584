// The measures of a live run, where each is known: a still camera looks at a wall.

#include <gtest/gtest.h>

#include "segmenter/evaluation/live/live_evaluation.hpp"
#include "tests/segmenter/evaluation/live/watched_wall.hpp"

namespace kintsugi::segmenter {
namespace {

using testing::BusEvent;
using testing::kBorder_m;
using testing::kWall_m;
using testing::labels_of;
using testing::wall_slice;

LiveReport evaluate(std::vector<BusEvent> events) {
  testing::in_order_of_time(events);
  LiveEvaluation evaluation(LiveConfig{});
  for (BusEvent& event : events) {
    std::visit([&](auto& message) { evaluation.add(message, event.time_s); }, event.message);
  }
  return evaluation.report();
}

/// Of the width that the camera sees of the wall.
double share_left_of(double x) {
  const double half_width_m = 320.0 / 525.0 * kWall_m;
  return (x + half_width_m) / (2.0 * half_width_m);
}

/// The left part has its labels after 1 s, the right one, with the centre of the view, after
/// 4.25 s.
class WatchedWall : public ::testing::Test {
 protected:
  CloudSlice left_ = wall_slice(0, 0, -1.5, kBorder_m, kWall_m);
  CloudSlice right_ = wall_slice(1, 0, kBorder_m, 1.5, kWall_m);
  std::vector<BusEvent> events_ = testing::watch_wall();

  void SetUp() override {
    events_.push_back({0.55, left_});
    events_.push_back({0.95, labels_of(left_, 1)});
    events_.push_back({3.05, right_});
    events_.push_back({4.25, labels_of(right_, 2)});
  }
};

// Of the views from 2 s to 10 s, 23 come before the labels of the right part and 58 after.
constexpr double kBefore = 23.0 / 81.0;

TEST_F(WatchedWall, SurfaceCountsFromTheMomentOnWhenItsLabelsHaveCome) {
  const LiveReport report = evaluate(events_);
  EXPECT_EQ(report.num_views, 81);
  EXPECT_EQ(report.num_centre, 81);
  EXPECT_EQ(report.num_centre_covered, 58);
  EXPECT_EQ(report.num_centre_right, 58);
  EXPECT_NEAR(*report.covered_mean, 1.0 - kBefore * (1.0 - share_left_of(kBorder_m + 0.03)), 0.01);
  EXPECT_NEAR(*report.covered_worst_tenth, share_left_of(kBorder_m + 0.03), 0.01);
}

TEST_F(WatchedWall, DelayIsFromEightFramesInSightToTheLabel) {
  // In the first view in one frame, in each later one in three more: ten after the fourth, 0.3 s.
  const LiveReport report = evaluate(events_);
  EXPECT_NEAR(*report.delay_median_s, 4.25 - 0.3, 1e-6);
  EXPECT_NEAR(*report.delay_p99_s, 4.25 - 0.3, 1e-6);
  // 48 x 36 regions of 5 cm in 2.44 x 1.83 m; those at the rim of the view may be in it or not.
  EXPECT_NEAR(static_cast<double>(report.num_delays), 2.44 * 1.83 / 0.0025, 120.0);
  EXPECT_NEAR(static_cast<double>(report.num_regions), 3.0 * 2.4 / 0.0025, 10.0);
}

TEST_F(WatchedWall, SurfaceThatWasLabelledBeforeItWasSeenLongEnoughHasNoDelay) {
  for (BusEvent& event : events_) {
    if (!std::holds_alternative<CameraView>(event.message)) event.time_s = 0.15;
  }
  EXPECT_EQ(evaluate(events_).delay_p99_s, 0.0);
}

TEST_F(WatchedWall, PixelsAreNeverAnsweredWithWhatIsBehindAndRaysAre) {
  const CloudSlice behind = wall_slice(2, 0, -2.0, 2.0, 3.0);
  events_.push_back({0.55, behind});
  events_.push_back({0.95, labels_of(behind, 3)});
  const LiveReport report = evaluate(events_);
  EXPECT_EQ(report.pixel.num_asked, 81 * 25);
  EXPECT_EQ(report.pixel.num_wrong, 0);
  EXPECT_EQ(report.pixel.num_behind, 0);
  // Of the five columns of pixels, one is left of the border: x = -0.98 m, the next one -0.49 m.
  EXPECT_EQ(report.pixel.num_answered, 23 * 5 + 58 * 25);
  EXPECT_EQ(report.ray.num_answered, 81 * 25);
  EXPECT_EQ(report.ray.num_behind, 23 * 20);
  EXPECT_EQ(report.ray.num_wrong, 23 * 20);
  EXPECT_EQ(report.num_centre_covered, 58);
}

TEST_F(WatchedWall, AnIdThatIsMergedIntoTheFinalOneIsRight) {
  SegmentUpdate merge = testing::relabelled(right_, 1);
  merge.events.push_back({SegmentEventType::kMerged, 1, 2});
  events_.push_back({7.05, merge});
  const LiveReport report = evaluate(events_);
  EXPECT_EQ(report.num_centre_right, 58);
  EXPECT_EQ(report.num_segments, 1);
  EXPECT_EQ(report.num_handovers, 1);
  EXPECT_EQ(report.num_changes, report.num_changes_by_merge);
  // All regions of the right part, once.
  EXPECT_NEAR(static_cast<double>(report.num_changes), 2.1 * 2.4 / 0.0025, 60.0);
  EXPECT_EQ(report.num_unchanged + report.num_changes, report.num_regions);
}

TEST_F(WatchedWall, AnIdThatOnlyLostItsSurfaceIsWrong) {
  events_.push_back({7.05, testing::relabelled(right_, 3)});
  const LiveReport report = evaluate(events_);
  EXPECT_EQ(report.num_centre_covered, 58);
  EXPECT_EQ(report.num_centre_right, 30);  // those after 7.05 s
  EXPECT_GT(report.num_changes, 0);
  EXPECT_EQ(report.num_changes_by_merge, 0);
}

TEST_F(WatchedWall, ChangesInTheFirstSecondDoNotCount) {
  events_.push_back({4.95, testing::relabelled(right_, 3)});
  const LiveReport report = evaluate(events_);
  EXPECT_EQ(report.num_changes, 0);
  EXPECT_EQ(report.num_unchanged, report.num_regions);
}

TEST_F(WatchedWall, ARevisionReplacesTheOneBeforeWhenItsLabelsHaveCome) {
  // The right part was wrong by 20 cm; its correction comes at 6 s, the labels at 8.05 s.
  CloudSlice corrected = wall_slice(1, 3, kBorder_m, 1.5, kWall_m + 0.2);
  events_.push_back({6.0, corrected});
  events_.push_back({8.05, labels_of(corrected, 2)});
  const LiveReport report = evaluate(events_);
  EXPECT_EQ(report.num_centre_covered, 38);  // from 4.25 s to 8.05 s
  EXPECT_EQ(report.revisions_sent, 3);
  EXPECT_EQ(report.points_sent, std::ssize(left_.points_W) + 2 * std::ssize(right_.points_W));
  EXPECT_EQ(report.num_points, std::ssize(left_.points_W) + std::ssize(right_.points_W));
}

TEST_F(WatchedWall, ARevisionWhosePointsWereLeftOutChangesNothing) {
  CloudSlice superseded = wall_slice(1, 3, 0.0, 0.0, kWall_m);
  superseded.superseded = true;
  events_.push_back({6.0, superseded});
  const LiveReport report = evaluate(events_);
  EXPECT_EQ(report.num_centre_covered, 58);
  EXPECT_EQ(report.revisions_sent, 2);
}

TEST_F(WatchedWall, LabelsMayComeBeforeTheirSlice) {
  for (BusEvent& event : events_) {
    if (std::holds_alternative<SegmentUpdate>(event.message)) event.time_s -= 3.0;
  }
  EXPECT_EQ(evaluate(events_).num_centre_covered, 70);  // from 3.05 s on
}

TEST_F(WatchedWall, AViewOfALostCameraIsNotCounted) {
  for (BusEvent& event : events_) {
    auto* const view = std::get_if<CameraView>(&event.message);
    if (view != nullptr && event.time_s > 8.95) view->state = TrackingState::kLost;
  }
  const LiveReport report = evaluate(events_);
  EXPECT_EQ(report.num_lost, 11);
  EXPECT_EQ(report.num_views, 70);
}

}  // namespace
}  // namespace kintsugi::segmenter
