#include "segmenter/objects/process/change_reports.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <set>

#include "segmenter/objects/maps/surface_samples.hpp"

namespace kintsugi::segmenter {
namespace {

Eigen::AlignedBox3f box_of(const ChangeReport& report) {
  return {Eigen::Vector3f(report.box_min_W), Eigen::Vector3f(report.box_max_W)};
}

/// What is known of the change without its number.
ChangeReport report_of(const MapChange& change) {
  ChangeReport report;
  report.kind = change.kind;
  report.score = static_cast<float>(std::clamp(change.score, 0.0, 1.0));
  report.motion_W = change.X_after_before;
  Eigen::AlignedBox3f box;
  for (const CloudPoint& point : change.points()) box.extend(position_of(point));
  for (int axis = 0; axis < 3; ++axis) {
    report.box_min_W[axis] = box.min()[axis];
    report.box_max_W[axis] = box.max()[axis];
  }
  report.points = static_cast<std::int32_t>(change.points().size());
  report.segment_ids = change.after_segments;
  if (report.segment_ids.size() > kMaxObjectSegments) report.segment_ids.resize(kMaxObjectSegments);
  return report;
}

bool is_as_reported(const ChangeReport& a, const ChangeReport& b) {
  return a.kind == b.kind && a.points == b.points && a.segment_ids == b.segment_ids &&
         a.motion_W.matrix() == b.motion_W.matrix() && box_of(a).isApprox(box_of(b));
}

/// The place of one is the place of the other, too: each box has the middle of the other.
bool is_at(const ChangeReport& a, const ChangeReport& b) {
  return box_of(a).contains(box_of(b).center()) && box_of(b).contains(box_of(a).center());
}

/// The report that is nearest to the place of `now`, of those that are not taken; nothing: none is.
std::optional<std::size_t> earlier_of(const ChangeReport& now,
                                      const std::vector<ChangeReport>& reports,
                                      const std::set<std::size_t>& taken) {
  std::optional<std::size_t> nearest;
  float least_m = std::numeric_limits<float>::max();
  for (std::size_t i = 0; i < reports.size(); ++i) {
    if (taken.contains(i) || !is_at(now, reports[i])) continue;
    const float distance_m = (box_of(now).center() - box_of(reports[i]).center()).norm();
    if (distance_m >= least_m) continue;
    least_m = distance_m;
    nearest = i;
  }
  return nearest;
}

}  // namespace

void ChangeReports::forget_withdrawn() {
  std::vector<std::int64_t> events;
  for (const ChangeReport& report : reports_) {
    if (report.kind == ChangeKind::kWithdrawn) events.push_back(report.event_number);
  }
  if (events.size() <= kMaxWithdrawn) return;
  const auto oldest_kept = events.end() - kMaxWithdrawn;
  std::ranges::nth_element(events, oldest_kept);
  std::erase_if(reports_, [&](const ChangeReport& report) {
    return report.kind == ChangeKind::kWithdrawn && report.event_number < *oldest_kept;
  });
}

void ChangeReports::update(const MapChanges& now, const ReportedMap& map) {
  forget_withdrawn();
  std::set<std::size_t> taken;
  const auto set = [&](std::size_t i, ChangeReport report) {
    report.change = reports_[i].change;
    report.event_number = ++num_events_;
    reports_[i] = std::move(report);
  };
  for (const MapChange& change : now.changes) {
    ChangeReport report = report_of(change);
    const std::optional<std::size_t> earlier = earlier_of(report, reports_, taken);
    const std::size_t i = earlier.value_or(reports_.size());
    if (!earlier) reports_.emplace_back().change = ++num_changes_;
    taken.insert(i);
    if (!earlier || !is_as_reported(report, reports_[i])) set(i, std::move(report));
  }
  for (std::size_t i = 0; i < reports_.size(); ++i) {
    if (taken.contains(i) || reports_[i].kind == ChangeKind::kWithdrawn) continue;
    ChangeReport withdrawn = reports_[i];
    withdrawn.kind = ChangeKind::kWithdrawn;
    set(i, std::move(withdrawn));
  }
  for (ChangeReport& report : reports_) {
    report.utime = map.utime;
    report.session = session_;
    report.map_session = map.map_session;
    report.map_name = map.map_name;
    report.before = before_;
    report.num_changes = num_changes_;
  }
}

}  // namespace kintsugi::segmenter
