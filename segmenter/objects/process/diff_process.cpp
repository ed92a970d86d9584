#include "segmenter/objects/process/diff_process.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "lcmtypes/base/logger.hpp"
#include "lcmtypes/base/stop_signal.hpp"
#include "lcmtypes/base/thread_priority.hpp"
#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/channels.hpp"
#include "lcmtypes/stream/stream_subscriber.hpp"
#include "segmenter/library/bus.hpp"
#include "segmenter/objects/changes/change_files.hpp"
#include "segmenter/objects/maps/align_maps.hpp"
#include "segmenter/objects/process/change_reports.hpp"
#include "segmenter/objects/process/comparison_schedule.hpp"
#include "segmenter/process/view_recorder.hpp"

namespace kintsugi::segmenter {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kWait(20);
constexpr milliseconds kRepeatPeriod(1000);  // of all reports, for those who come late

/// What a comparison was of, and what it found.
struct Comparison {
  ReportedMap map;
  bool is_of_complete_map = false;
  std::string refusal;  ///< why the maps do not fit; empty: they do
  MapChanges changes;
};

Comparison compare(const ObservedMap& before, const ObservedMap& now, ReportedMap map,
                   const std::filesystem::path& out) {
  Comparison comparison{.map = std::move(map), .refusal = {}, .changes = {}};
  const AlignmentResult aligned = align_maps(before, now);
  if (!aligned.alignment) {
    comparison.refusal = aligned.refusal;
    return comparison;
  }
  const MapDifference difference{.before = before.source,
                                 .after = now.source,
                                 .before_session = before.map_session,
                                 .after_session = now.map_session,
                                 .alignment = *aligned.alignment,
                                 .changes = find_changes(before, now, aligned.alignment->X_AB)};
  write_changes(difference, now, out);
  comparison.changes = difference.changes;
  return comparison;
}

class DiffProcess {
 public:
  DiffProcess(const ObservedMap& before, const DiffProcessOptions& options)
      : before_(before),
        options_(options),
        bus_(options.lcm_url),
        client_(MapClient::connect({.url = options.lcm_url, .map_name = options.map_name})),
        views_(options.map_name),
        camera_views_(channels::kCameraView, [this](const CameraView& view) { views_.add(view); }),
        slices_(channels::kCloudSlice, [this](const CloudSlice& slice) { views_.add(slice); }),
        schedule_(std::chrono::duration<double>(options.every_s)) {
    camera_views_.subscribe(bus_);
    slices_.subscribe(bus_);
  }

  int run() {
    spdlog::info("follows {}",
                 options_.map_name.empty() ? "the first map it hears of" : options_.map_name);
    while (!stop_requested() && !(options_.exit_on_final && is_finished_)) {
      receive();
      if (is_due()) begin_comparison();
      take_comparison();
      publish();
    }
    publish_all();
    return 0;
  }

 private:
  void receive() {
    while (bus_.handle(milliseconds(0))) {
    }
    const kintsugi::MapChanges changes = client_.wait(kWait);
    const SegmentUpdate* const newest = client_.newest_update();
    if (newest == nullptr) return;
    if (newest->map_session != map_.map_session) begin_map(*newest);
    for (const SegmentUpdate& update : changes.updates) {
      map_.utime = std::max(map_.utime, update.utime);
    }
    if (!changes.updates.empty() || !changes.pieces.empty()) schedule_.note_news();
  }

  void begin_map(const SegmentUpdate& newest) {
    map_ = {.utime = newest.utime, .map_session = newest.map_session, .map_name = newest.map_name};
    session_ = std::max(new_session(), session_ + 1);
    reports_ = std::make_unique<ChangeReports>(session_, before_.source);
    published_ = 0;
    schedule_.note_news();
    is_finished_ = false;
  }

  [[nodiscard]] bool is_complete() const { return client_.is_complete() && client_.has_ended(); }

  [[nodiscard]] bool is_due() const {
    if (running_.valid() || client_.resolution_m() <= 0.0F) return false;
    return schedule_.is_due(is_complete(), Clock::now());
  }

  /// The map as it is now. A copy: it grows while it is compared.
  [[nodiscard]] ObservedMap snapshot() const {
    ObservedMap map;
    map.source = map_.map_name;
    map.map_name = map_.map_name;
    map.map_session = map_.map_session;
    map.resolution_m = client_.resolution_m();
    for (const std::int32_t piece : client_.pieces()) {
      const auto points = client_.points_W(piece);
      const auto labels = client_.labels(piece);
      map.points_W.insert(map.points_W.end(), points->begin(), points->end());
      map.segment_ids.insert(map.segment_ids.end(), labels.begin(), labels.end());
    }
    const auto views = views_.views(map_.map_session);
    if (views == nullptr) return map;
    for (KeptView view : views->views) {
      view.patch = KeptView::kNoPatch;  // it is where it is now
      map.views.push_back(unpacked(view, [](std::int32_t) { return std::nullopt; }));
    }
    return map;
  }

  void begin_comparison() {
    schedule_.begin(is_complete(), Clock::now());
    running_ = std::async(std::launch::async, [this, now = snapshot(), map = map_,
                                               is_of_complete_map = is_complete()]() mutable {
      lower_priority_of_thread();
      Comparison comparison = compare(before_, now, std::move(map), options_.out);
      comparison.is_of_complete_map = is_of_complete_map;
      return comparison;
    });
  }

  void take_comparison() {
    if (!running_.valid() || running_.wait_for(milliseconds(0)) != std::future_status::ready) {
      return;
    }
    const Comparison comparison = running_.get();
    if (comparison.map.map_session != map_.map_session) return;  // of a map that was given up
    is_finished_ = comparison.is_of_complete_map;
    if (!comparison.refusal.empty()) {
      const std::string reason = before_.source + " and the map on the bus: " + comparison.refusal;
      if (is_finished_ && options_.exit_on_final) throw std::runtime_error(reason);
      if (reason != refusal_) spdlog::warn("{}", reason);
      refusal_ = reason;
      return;
    }
    refusal_.clear();
    reports_->update(comparison.changes, comparison.map);
    spdlog::info("{} changes{}", comparison.changes.changes.size(),
                 is_finished_ ? "; the map is complete" : "");
  }

  void publish() {
    const Clock::time_point now = Clock::now();
    if (reports_ && reports_->num_events() > published_) {
      publish_since(published_);
      published_ = reports_->num_events();
    }
    if (now - last_repeat_ < kRepeatPeriod) return;
    last_repeat_ = now;
    publish_all();
  }

  void publish_all() { publish_since(0); }

  /// The reports whose last event is later.
  void publish_since(std::int64_t event_number) {
    if (!reports_) return;
    std::vector<ChangeReport> reports;
    for (const ChangeReport& report : reports_->reports()) {
      if (report.event_number > event_number) reports.push_back(report);
    }
    std::ranges::sort(reports, {}, &ChangeReport::event_number);
    for (const ChangeReport& report : reports) bus_.publish(channels::kChangeReport, report);
  }

  const ObservedMap& before_;
  const DiffProcessOptions options_;
  Bus bus_;  // for what is published, and for views
  MapClient client_;
  ViewRecorder views_;
  StreamSubscriber<CameraView> camera_views_;
  StreamSubscriber<CloudSlice> slices_;
  ReportedMap map_;
  std::int64_t session_ = 0;
  std::unique_ptr<ChangeReports> reports_;  // null: no map is known yet
  std::int64_t published_ = 0;              // the newest event
  ComparisonSchedule schedule_;
  bool is_finished_ = false;
  std::string refusal_;  // that was told last
  Clock::time_point last_repeat_{};
  std::future<Comparison> running_;  // the last: it is waited for before the others end
};

}  // namespace

int run_diff(const ObservedMap& before, const DiffProcessOptions& options) {
  return DiffProcess(before, options).run();
}

}  // namespace kintsugi::segmenter
