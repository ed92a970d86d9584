// Changes of a running map keep their numbers.

#include <cstdint>
#include <vector>

#include <gmock/gmock.h>

#include "lcmtypes/codec/codec.hpp"
#include "segmenter/objects/process/change_reports.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::ElementsAre;

/// A cube of 20 cm.
std::vector<CloudPoint> cube_at(float x_m) {
  std::vector<CloudPoint> points;
  for (int i = 0; i < 8; ++i) {
    CloudPoint& p = points.emplace_back();
    p.x = x_m + (i & 1 ? 0.1F : -0.1F);
    p.y = i & 2 ? 0.1F : -0.1F;
    p.z = i & 4 ? 0.1F : -0.1F;
  }
  return points;
}

MapChange change_at(float x_m, ChangeKind kind) {
  MapChange change;
  change.kind = kind;
  (kind == ChangeKind::kGone ? change.before : change.after) = cube_at(x_m);
  if (kind != ChangeKind::kGone) change.after_segments = {4, 9};
  change.score = 0.8;
  return change;
}

MapChanges changes_of(std::vector<MapChange> changes) {
  MapChanges all;
  all.changes = std::move(changes);
  return all;
}

std::vector<ChangeKind> kinds_of(const ChangeReports& reports) {
  std::vector<ChangeKind> kinds;
  for (const ChangeReport& report : reports.reports()) {
    kinds.push_back(report.kind);
    EXPECT_EQ(decode<ChangeReport>(encode(report)).change, report.change);  // it may be sent
  }
  return kinds;
}

const ReportedMap kMap{.utime = 7, .map_session = 3, .map_name = "hall"};

TEST(ChangeReports, KeepTheirNumbersAsLongAsTheyHold) {
  ChangeReports reports(11, "hall yesterday");
  reports.update(
      changes_of({change_at(0.0F, ChangeKind::kNew), change_at(1.0F, ChangeKind::kGone)}), kMap);
  EXPECT_THAT(kinds_of(reports), ElementsAre(ChangeKind::kNew, ChangeKind::kGone));
  EXPECT_EQ(reports.num_events(), 2);
  const ChangeReport& first = reports.reports()[0];
  EXPECT_EQ(first.session, 11);
  EXPECT_EQ(first.map_session, 3);
  EXPECT_EQ(first.map_name, "hall");
  EXPECT_EQ(first.before, "hall yesterday");
  EXPECT_THAT(first.segment_ids, ElementsAre(4, 9));
  EXPECT_FLOAT_EQ(first.box_max_W[0], 0.1F);

  // In another order, and nothing new: no event.
  reports.update(
      changes_of({change_at(1.0F, ChangeKind::kGone), change_at(0.0F, ChangeKind::kNew)}), kMap);
  EXPECT_THAT(kinds_of(reports), ElementsAre(ChangeKind::kNew, ChangeKind::kGone));
  EXPECT_EQ(reports.num_events(), 2);
}

TEST(ChangeReports, TellWhatHasBecomeOfAChange) {
  ChangeReports reports(11, "before");
  reports.update(changes_of({change_at(0.0F, ChangeKind::kNew)}), kMap);
  MapChange moved = change_at(0.02F, ChangeKind::kMoved);
  moved.before = cube_at(2.0F);
  moved.X_after_before.translation().x() = -1.98;
  reports.update(changes_of({moved, change_at(1.0F, ChangeKind::kNew)}), kMap);
  EXPECT_THAT(kinds_of(reports), ElementsAre(ChangeKind::kMoved, ChangeKind::kNew));
  EXPECT_EQ(reports.reports()[0].event_number, 2);
  EXPECT_EQ(reports.reports()[0].num_changes, 2);

  reports.update(changes_of({change_at(1.0F, ChangeKind::kNew)}), kMap);
  EXPECT_THAT(kinds_of(reports), ElementsAre(ChangeKind::kWithdrawn, ChangeKind::kNew));
  EXPECT_EQ(reports.num_events(), 4);
  reports.update(changes_of({change_at(1.0F, ChangeKind::kNew)}), kMap);
  EXPECT_EQ(reports.num_events(), 4);  // withdrawn once
  reports.update(
      changes_of({change_at(0.0F, ChangeKind::kGone), change_at(1.0F, ChangeKind::kNew)}), kMap);
  EXPECT_THAT(kinds_of(reports), ElementsAre(ChangeKind::kGone, ChangeKind::kNew));
}

TEST(ChangeReports, ForgetWhatWasWithdrawnLongAgo) {
  ChangeReports reports(11, "before");
  constexpr auto kMany = static_cast<int>(ChangeReports::kMaxWithdrawn);
  std::vector<MapChange> changes{change_at(-1.0F, ChangeKind::kNew)};
  for (int i = 0; i < 3 * kMany; ++i) {
    changes.push_back(change_at(static_cast<float>(i), ChangeKind::kNew));
  }
  reports.update(changes_of(changes), kMap);
  changes.resize(1);
  reports.update(changes_of(changes), kMap);
  EXPECT_EQ(kinds_of(reports).size(), 1U + 3 * kMany);  // each is told once
  reports.update(changes_of(changes), kMap);
  ASSERT_EQ(kinds_of(reports).size(), 1U + kMany);
  EXPECT_EQ(reports.reports()[0].kind, ChangeKind::kNew);
  EXPECT_EQ(reports.reports()[0].change, 1);
  EXPECT_EQ(reports.reports()[1].change, 2 + 2 * kMany);  // the newest

  // What was forgotten begins anew; what is known keeps its number.
  changes.push_back(change_at(0.0F, ChangeKind::kNew));
  changes.push_back(change_at(static_cast<float>(3 * kMany - 1), ChangeKind::kNew));
  reports.update(changes_of(changes), kMap);
  ASSERT_EQ(kinds_of(reports).size(), 2U + kMany);
  EXPECT_EQ(reports.reports().back().change, 2 + 3 * kMany);
  EXPECT_EQ(reports.reports().back().num_changes, 2 + 3 * kMany);
  const ChangeReport& known = reports.reports()[kMany];
  EXPECT_EQ(known.change, 1 + 3 * kMany);
  EXPECT_EQ(known.kind, ChangeKind::kNew);
}

TEST(ChangeReports, OfVeryManySegmentsFitAMessage) {
  ChangeReports reports(11, "before");
  MapChange change = change_at(0.0F, ChangeKind::kNew);
  change.after_segments.clear();
  for (std::uint32_t id = 1; id <= 2'000; ++id) change.after_segments.push_back(id);
  reports.update(changes_of({change}), kMap);
  EXPECT_THAT(kinds_of(reports), ElementsAre(ChangeKind::kNew));
}

}  // namespace
}  // namespace kintsugi::segmenter
