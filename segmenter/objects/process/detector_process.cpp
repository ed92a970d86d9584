#include "segmenter/objects/process/detector_process.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "lcmtypes/base/atomic_file.hpp"
#include "lcmtypes/base/logger.hpp"
#include "lcmtypes/base/process_memory.hpp"
#include "lcmtypes/base/service_notice.hpp"
#include "lcmtypes/base/stop_signal.hpp"
#include "lcmtypes/base/thread_priority.hpp"
#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/channels.hpp"
#include "segmenter/library/bus.hpp"
#include "segmenter/objects/library/object_library.hpp"
#include "segmenter/objects/process/cpu_budget.hpp"
#include "segmenter/objects/process/detection_messages.hpp"
#include "segmenter/objects/process/due_pieces.hpp"
#include "segmenter/objects/process/followed_views.hpp"
#include "segmenter/objects/process/map_detection.hpp"

namespace kintsugi::segmenter {

namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kWait(20);
constexpr milliseconds kStatusPeriod(500);
constexpr milliseconds kRepeatPeriod(1000);  // of all detections, for those who come late
constexpr std::size_t kLags = 1000;          // the newest, of which the status tells the median

bool is_segment(std::uint32_t label) { return label != kNoSegment; }

/// Names what is refused, once.
ObjectLibrary read_library(const std::filesystem::path& folder, const ObjectLibrary& earlier) {
  ObjectLibrary library = ObjectLibrary::read(folder, earlier);
  for (const RefusedObject& refused : library.refusals()) {
    spdlog::warn("{} is not used: {}", refused.name, refused.reason);
  }
  spdlog::info("{}: {} objects", folder.string(), library.objects().size());
  return library;
}

class DetectorProcess {
 public:
  explicit DetectorProcess(const DetectorOptions& options)
      : options_(options),
        bus_(options.lcm_url),
        client_(MapClient::connect({.url = options.lcm_url, .map_name = options.map_name})),
        views_(FollowedViews::of_segmenter(options.lcm_url)),
        library_(read_library(options.library, {})),
        budget_(options.cpu_share) {}

  int run() {
    spdlog::info(
        "follows {}, at most {:.0f} % of a core",
        options_.map_name.empty() ? "the first map it hears of" : "map " + options_.map_name,
        100 * options_.cpu_share);
    while (!stop_requested() && !(options_.exit_on_final && is_finished_)) {
      receive();
      if (detector_ && views_.update(has_ended(), *detector_)) is_complete_pass_ = false;
      examine();
      publish();
      tell_service_manager();
    }
    publish_all();
    publish_status();
    if (!options_.json.empty()) write_json();
    return 0;
  }

 private:
  void receive() {
    const bool can_work = detector_ && has_work() && may_work();
    const MapChanges changes = client_.wait(can_work ? milliseconds(0) : kWait);
    for (const std::int32_t piece : changes.pieces) pieces_.add(piece);
    if (const SegmentUpdate* newest = client_.newest_update()) {
      if (newest->map_session != source_.map_session) begin_map(*newest);
      updates_ += static_cast<std::int64_t>(changes.updates.size());
      for (const SegmentUpdate& update : changes.updates) {
        source_.utime = std::max(source_.utime, update.utime);
      }
    }
    // Points may come before the first update, which tells whose map it is.
    if (!pieces_.empty() && !detector_ && source_.map_session != 0) make_detector();
    if (!detector_) return;
    if (has_ended()) pieces_.try_all();  // what has no segments yet gets none
    const std::size_t num_added =
        pieces_.take_each([this](std::int32_t piece) { return add_piece(piece); });
    if (num_added > 0) {
      is_complete_pass_ = false;
      views_.go_on();
    }
  }

  void begin_map(const SegmentUpdate& newest) {
    source_ = {
        .map = newest.map_name, .map_session = newest.map_session, .session = source_.session};
    detector_.reset();
    pieces_.clear();
    for (const std::int32_t piece : client_.pieces()) pieces_.add(piece);
  }

  /// Of another map, or with another library: a new session, since the numbers of detections begin
  /// again.
  void make_detector() {
    if (client_.resolution_m() <= 0.0F) return;
    if (has_numbers_) source_.session = std::max(new_session(), source_.session + 1);
    has_numbers_ = true;
    recognizer_ = std::make_shared<const ObjectRecognizer>(
        models_of(library_), client_.resolution_m(), recognizer_.get());
    spdlog::info("{} objects prepared", recognizer_->num_prepared());
    detector_ = std::make_unique<Detector>(recognizer_, source_.map_session);
    views_.begin(source_.map_session);
    published_ = 0;
    is_complete_pass_ = false;
    is_finished_ = false;
  }

  /// Points come before their labels: until these are there, the detector keeps the piece as it
  /// was. Without segments, what is in it would seem to be gone.
  bool add_piece(std::int32_t piece) {
    LabelledMap::Points points_W = client_.points_W(piece);
    std::vector<std::uint32_t> labels = client_.labels(piece);
    const bool is_segmented = points_W->empty() || std::ranges::any_of(labels, is_segment);
    if (!is_segmented && !has_ended()) return false;
    const LabelledMap::Points before_W = detector_->map().points_of_piece(piece);
    if (before_W && before_W != points_W && is_moved(*before_W, *points_W)) {
      views_.note_correction();
    }
    detector_->set_piece(piece, std::move(points_W), std::move(labels), source_.utime);
    return true;
  }

  /// When all is mapped, the camera sees nothing any more that the processor would be needed for.
  bool may_work() { return client_.is_mapped() || budget_.has_some(); }

  /// The last examination begins while the views are still asked for, and begins again if they are
  /// others than before. Since what is gone is told at its end, some segments wait until then.
  [[nodiscard]] bool has_work() const {
    const bool may_end = !is_complete_pass_ || views_.are_complete();
    return detector_->num_waiting() > (may_end ? 0 : Detector::most_at_once());
  }

  [[nodiscard]] bool has_ended() const { return client_.is_complete() && client_.has_ended(); }

  void examine() {
    if (!detector_) return;
    if (has_ended()) finish();
    const Clock::time_point begin = Clock::now();
    while (has_work() && Clock::now() - begin < kWait && may_work()) {
      const double cpu_s = CpuBudget::cpu_s();
      const std::int64_t since_us =
          is_complete_pass_ ? *detector_->examine_many() : *detector_->examine_next();
      worst_burst_s_ = std::max(worst_burst_s_, CpuBudget::cpu_s() - cpu_s);
      lags_ms_.push_back(1e-3 * static_cast<double>(source_.utime - since_us));
      if (lags_ms_.size() > kLags) lags_ms_.pop_front();
    }
  }

  /// Once more all of a closed map: then the detections depend on the map, what the cameras saw of
  /// it and the library alone.
  void finish() {
    if (!is_complete_pass_) {
      is_complete_pass_ = true;
      detector_->examine_all();
    }
    if (detector_->num_waiting() > 0 || !views_.are_complete()) return;
    if (!is_finished_) spdlog::info("the map is complete and examined");
    is_finished_ = true;
  }

  void publish() {
    const Clock::time_point now = Clock::now();
    if (detector_ && detector_->num_changes() > published_) publish_changes();
    if (now - last_repeat_ >= kRepeatPeriod) {
      last_repeat_ = now;
      publish_all();
      reload_library();
    }
    if (now - last_status_ >= kStatusPeriod) {
      last_status_ = now;
      publish_status();
    }
  }

  void publish_changes() {
    std::vector<const Detection*> changed;
    for (const Detection& detection : detector_->detections()) {
      if (detection.change_number > published_) changed.push_back(&detection);
    }
    std::sort(changed.begin(), changed.end(), [](const Detection* a, const Detection* b) {
      return a->event_number < b->event_number;
    });
    for (const Detection* detection : changed) {
      bus_.publish(channels::kObjectDetection, message_of(*detection, *detector_, source_));
    }
    published_ = detector_->num_changes();
  }

  void publish_all() {
    if (!detector_) return;
    for (const Detection& detection : detector_->detections()) {
      bus_.publish(channels::kObjectDetection, message_of(detection, *detector_, source_));
    }
  }

  /// Objects that were taught meanwhile are looked for, too.
  void reload_library() {
    try {
      const bool has_changed = library_.has_changed();
      problem_.clear();  // it can be read
      if (!has_changed) return;
      library_ = read_library(options_.library, library_);
    } catch (const std::exception& error) {
      if (problem_ != error.what()) spdlog::error("{}", error.what());
      problem_ = error.what();
      return;
    }
    detector_.reset();
    for (const std::int32_t piece : client_.pieces()) pieces_.add(piece);
  }

  void publish_status() {
    DetectorStatus status;
    status.utime = wall_clock_us();
    status.session = source_.session;
    status.map_session = source_.map_session;
    status.finished = is_finished_;
    status.library_objects = static_cast<std::int64_t>(library_.objects().size());
    status.library_refused = static_cast<std::int64_t>(library_.refusals().size());
    status.updates_applied = updates_;
    if (detector_) count(status);
    status.memory_bytes = process_memory().resident_bytes;
    if (!lags_ms_.empty()) {
      std::vector<double> lags(lags_ms_.begin(), lags_ms_.end());
      const auto middle = lags.begin() + static_cast<std::ptrdiff_t>(lags.size() / 2);
      std::nth_element(lags.begin(), middle, lags.end());
      status.lag_p50_ms = *middle;
      status.lag_max_ms = *std::max_element(lags.begin(), lags.end());
    }
    status.cpu_share = share_.now();
    status.worst_burst_ms = 1e3 * worst_burst_s_;
    status.map_name = source_.map;
    status.library = options_.library.string();
    // That there is no map yet is told by map_session.
    const bool has_map = source_.map_session != 0;
    status.problem = problem_;
    if (status.problem.empty() && has_map) status.problem = client_.problem();
    if (status.problem.empty()) status.problem = views_.problem();
    report_refused(status);
    bus_.publish(channels::kDetectorStatus, status);
  }

  void count(DetectorStatus& status) const {
    status.points = detector_->map().num_points();
    status.segments = static_cast<std::int64_t>(detector_->map().num_segments());
    status.candidates_waiting = static_cast<std::int64_t>(detector_->num_waiting());
    status.candidates_examined = detector_->num_candidates();
    status.events = detector_->num_events();
    for (const Detection& detection : detector_->detections()) {
      switch (detection.event) {
        case DetectionEvent::kFound:
          ++status.detections_found;
          break;
        case DetectionEvent::kConfirmed:
        case DetectionEvent::kMoved:
          ++status.detections_confirmed;
          break;
        case DetectionEvent::kGone:
          ++status.detections_gone;
          break;
      }
    }
  }

  void write_json() const {
    AtomicFile file(options_.json);
    if (detector_) {
      file.stream() << detections_json(*detector_, source_);
    } else {
      file.stream() << "{\"map\": \"\", \"detections\": []}\n";
    }
    file.commit();
  }

  const DetectorOptions options_;
  Bus bus_;  // for what is published
  MapClient client_;
  FollowedViews views_;
  ObjectLibrary library_;
  CpuBudget budget_;
  CpuShare share_;
  std::shared_ptr<const ObjectRecognizer> recognizer_;  // null: none was needed yet
  std::unique_ptr<Detector> detector_;                  // null: no map is known yet
  DetectionSource source_{.map = "", .session = new_session()};
  bool has_numbers_ = false;  // detections were numbered in the session
  DuePieces pieces_;          // that the detector has not, or not as they are
  bool is_complete_pass_ = false;
  bool is_finished_ = false;
  std::int64_t published_ = 0;  // the newest event
  std::int64_t updates_ = 0;
  std::deque<double> lags_ms_;
  double worst_burst_s_ = 0.0;
  std::string problem_;
  Clock::time_point last_repeat_{};
  Clock::time_point last_status_{};
};

}  // namespace

int run_detector(const DetectorOptions& options) {
  lower_priority_of_thread();
  return DetectorProcess(options).run();
}

}  // namespace kintsugi::segmenter
