// Sessions read from LCM logs.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "segmenter/evaluation/session/session_log.hpp"
#include "tests/segmenter/evaluation/session/log_of_slices.hpp"
#include "tests/segmenter/process/slice_session.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::segmenter {
namespace {

using kintsugi::testing::TemporaryFolder;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::pose_at;

class SessionLog : public ::testing::Test {
 protected:
  RecordedSession read() {
    testing::write_log(path(), messages_);
    return read_session_log(path());
  }
  std::filesystem::path path() const { return folder_ / "session.lcm"; }

  TemporaryFolder folder_;
  testing::LogMessages messages_;
};

TEST_F(SessionLog, HoldsSlicesTimesAndPath) {
  testing::append_pose(pose_at(0.0, 500), messages_);
  testing::append_slices(testing::wavy_session(3, 100), messages_);  // at 1000, 1001, 1002 us
  testing::append_pose(pose_at(3.0, 900), messages_);
  testing::append_pose(pose_at(2.0, 700), messages_);
  CameraPose lost = pose_at(100.0, 800);
  lost.state = TrackingState::kLost;
  testing::append_pose(lost, messages_);
  testing::append_pose(pose_at(50.0, 800, 6), messages_);  // of another session
  const RecordedSession session = read();
  EXPECT_EQ(session.num_slices, 3);
  EXPECT_EQ(session.num_points(), 300);
  EXPECT_EQ(ready_us(session.steps[2]), 1002);
  EXPECT_TRUE(session.has_times);
  EXPECT_TRUE(session.is_whole);
  EXPECT_THAT(session.remarks, IsEmpty());
  EXPECT_DOUBLE_EQ(session.path_length_m.value(), 3.0);
  EXPECT_DOUBLE_EQ(session.build_time_s.value(), 502e-6);
}

TEST_F(SessionLog, HoldsTheNumberOfSegmentsOfTheRun) {
  const auto slices = testing::wavy_session(3, 100);
  testing::append_slices(slices, messages_);
  EXPECT_FALSE(read().segments_of_run);
  SegmenterStatus status;
  status.session = 1;
  status.map_session = slices.front().session;
  for (const auto& [finished, segments] : {std::pair(false, 3), {true, 7}, {true, 8}}) {
    status.finished = finished;
    status.segments = segments;
    messages_.emplace_back(channels::kSegmenterStatus, encode(status));
  }
  status.map_session += 1;
  status.segments = 99;
  messages_.emplace_back(channels::kSegmenterStatus, encode(status));
  EXPECT_EQ(read().segments_of_run, 8);
}

TEST_F(SessionLog, WithoutPosesMeasuresAlongTheSlices) {
  auto slices = testing::wavy_session(3, 100);
  slices[1].X_WC.translation().y() = 1.0;
  slices[2].X_WC.translation().y() = 3.0;
  testing::append_slices(slices, messages_);
  const RecordedSession session = read();
  EXPECT_DOUBLE_EQ(session.path_length_m.value(), 3.0);
  EXPECT_DOUBLE_EQ(session.build_time_s.value(), 2e-6);
  EXPECT_THAT(session.remarks, Contains(HasSubstr("No camera poses")));
}

TEST_F(SessionLog, PutsSlicesInOrderAndCorrectionsWhereTheyCame) {
  auto slices = testing::wavy_session(4, 100);
  CloudSlice corrected = slices[1];
  corrected.revision = 2;
  corrected.points_W.pop_back();
  testing::append_slices({slices[1], slices[0], corrected, slices[3], slices[1], slices[2]},
                         messages_);
  const RecordedSession session = read();
  EXPECT_EQ(session.num_slices, 4);
  EXPECT_EQ(session.num_points(), 399);
  std::vector<std::pair<int, int>> steps;  // id and revision
  for (const SliceGroup& step : session.steps) {
    ASSERT_EQ(step.slices.size(), 1U);
    steps.emplace_back(step.slices[0].id, step.slices[0].revision);
  }
  EXPECT_THAT(steps, ElementsAre(std::pair(0, 0), std::pair(1, 0), std::pair(1, 2), std::pair(2, 0),
                                 std::pair(3, 0)));
  EXPECT_TRUE(session.is_whole);
  EXPECT_THAT(session.remarks, Contains(HasSubstr("1 corrections of slices")));
}

TEST_F(SessionLog, TakesTheSessionWithMostSlicesAndSaysSo) {
  testing::append_slices(testing::wavy_session(2, 50, 4), messages_);
  testing::append_slices(testing::wavy_session(3, 50, 7), messages_);
  const RecordedSession session = read();
  EXPECT_EQ(session.num_slices, 3);
  EXPECT_EQ(session.steps[0].slices[0].session, 7);
  EXPECT_THAT(session.remarks, Contains(HasSubstr("2 sessions")));
}

TEST_F(SessionLog, TellsWhatIsMissing) {
  const auto slices = testing::wavy_session(5, 50);
  testing::append_slices({slices[0], slices[2], slices[3]}, messages_);
  const RecordedSession session = read();
  EXPECT_FALSE(session.is_whole);
  EXPECT_THAT(session.remarks, AllOf(Contains(HasSubstr("1 slices are missing")),
                                     Contains(HasSubstr("before the final slice"))));
}

}  // namespace
}  // namespace kintsugi::segmenter
