#include "lcmtypes/tools/progress.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "lcmtypes/base/text_format.hpp"
#include "lcmtypes/tools/status_text.hpp"

namespace kintsugi {
namespace {

// A status is sent at least once a second: without any for so long there is a problem.
constexpr double kSilence_s = 5.0;

constexpr std::size_t kMaxMaps = 16;  // other maps whose names are kept

/// How often the process was restarted; empty: never.
std::string restarts_text(const char* process, int restarts) {
  if (restarts == 0) return {};
  if (restarts == 1) return format(" | %s restarted", process);
  return format(" | %s restarted %d times", process, restarts);
}

std::string problem_text(const char* process, const std::string& problem) {
  return problem.empty() ? std::string()
                         : std::string(" | PROBLEM of the ") + process + ": " + problem;
}

/// Each run of a process has larger session numbers than the one before it.
template <class Status>
bool is_later_run(const std::optional<Status>& before, const Status& status) {
  return before && status.session > before->session;
}

}  // namespace

bool Progress::is_watched(const std::string& map_name) {
  if (!map_name_) map_name_ = map_name;
  if (map_name == *map_name_) return true;
  if (other_maps_.size() < kMaxMaps) other_maps_.insert(map_name);
  return false;
}

void Progress::update(const MapperStatus& status, std::int64_t now_us) {
  if (!is_watched(status.map_name)) return;
  if (is_later_run(mapper_, status)) ++mapper_restarts_;
  mapper_ = status;
  note_progress(now_us);
}

void Progress::update(const SegmenterStatus& status, std::int64_t now_us) {
  if (is_of_other_map(status.map_name)) return;
  if (is_later_run(segmenter_, status)) ++segmenter_restarts_;
  segmenter_ = status;
  note_progress(now_us);
}

void Progress::update(const ViewerStatus& status, std::int64_t now_us) {
  if (is_of_other_map(status.map_name)) return;
  if (is_later_run(viewer_, status)) ++viewer_restarts_;
  viewer_ = status;
  note_progress(now_us);
}

void Progress::update(const DetectorStatus& status, std::int64_t now_us) {
  if (is_of_other_map(status.map_name)) return;
  if (is_later_run(detector_, status)) ++detector_restarts_;
  detector_ = status;
  note_progress(now_us);
}

bool Progress::finished(const OptionalProcesses& waited) const {
  return unfinished(waited).empty();
}

std::string Progress::unfinished(const OptionalProcesses& waited) const {
  std::string names;
  const auto add = [&names](const char* process, const char* why) {
    names += std::string(names.empty() ? "" : ", ") + process + " " + why;
  };
  if (!mapper_) {
    add("mapper", "sends no status");
  } else if (!mapper_->finished) {
    add("mapper", "not finished");
  }
  const auto add_follower = [this, &add](const auto& status) {
    const char* process = std::remove_cvref_t<decltype(*status)>::kProcess;
    if (!status) {
      add(process, "sends no status");
    } else if (!status->finished) {
      add(process, "not finished");
    } else if (mapper_ && status->map_session != mapper_->session) {
      add(process, "finished another map");
    }
  };
  add_follower(segmenter_);
  if (waited.viewer) add_follower(viewer_);
  if (waited.detector) add_follower(detector_);
  return names;
}

std::int64_t Progress::work_done() const {
  std::int64_t sum = 0;
  if (mapper_)
    sum += mapper_->frames_read + mapper_->chunks_published + (mapper_->finished ? 1 : 0);
  if (segmenter_) {
    sum += segmenter_->chunks_received + segmenter_->slices_segmented +
           segmenter_->slices_corrected + (segmenter_->finished ? 1 : 0);
  }
  if (viewer_) {
    sum += viewer_->updates_applied + viewer_->snapshots_written + (viewer_->finished ? 1 : 0);
  }
  if (detector_) {
    sum += detector_->updates_applied + detector_->candidates_examined + detector_->events +
           (detector_->finished ? 1 : 0);
  }
  return sum;
}

void Progress::note_progress(std::int64_t now_us) {
  last_heard_us_ = now_us;
  const std::int64_t work = work_done();
  // Less than before is progress, too: a process was restarted.
  if (work != work_done_) last_progress_us_ = now_us;
  work_done_ = work;
}

std::optional<double> Progress::time_left_s() const {
  if (!mapper_) return std::nullopt;
  double left_s = 0.0;
  if (!mapper_->finished) {
    if (mapper_->frames_total < 0 || mapper_->frame_rate_hz <= 0.0) return std::nullopt;
    left_s =
        static_cast<double>(mapper_->frames_total - mapper_->frames_read) / mapper_->frame_rate_hz;
  }
  if (segmenter_) {
    // The slices that wait are segmented while the mapper continues, or after it.
    left_s = std::max(
        left_s, static_cast<double>(segmenter_->lag_slices) * segmenter_->slice_mean_ms / 1000.0);
  }
  return std::max(left_s, 0.0);
}

std::string Progress::line(std::int64_t now_us) const {
  if (!heard_anything()) return "waiting: no status received yet";
  std::string text = (mapper_ ? text_of(*mapper_) : "no mapper") + " | " +
                     (segmenter_ ? text_of(*segmenter_) : "no segmenter");
  if (viewer_) text += " | " + text_of(*viewer_);
  if (detector_) text += " | " + text_of(*detector_);
  text += restarts_text("mapper", mapper_restarts_) +
          restarts_text("segmenter", segmenter_restarts_) +
          restarts_text("viewer", viewer_restarts_) +
          restarts_text("detector", detector_restarts_) + problems_text();
  const double silence_s = static_cast<double>(now_us - last_heard_us_) / 1e6;
  if (silence_s > kSilence_s) return text + format(" | silent for %.0f s", silence_s);
  if (finished({viewer_.has_value(), detector_.has_value()})) return text + " | finished";
  if (const auto left_s = time_left_s()) {
    const auto seconds = static_cast<long>(std::ceil(*left_s));
    text += format(" | %ld:%02ld left", seconds / 60, seconds % 60);
  }
  return text;
}

std::string Progress::problems_text() const {
  std::string text;
  if (!other_maps_.empty()) {
    text += " | another map: " + *other_maps_.begin();
    if (other_maps_.size() > 1) text += " and more";
  }
  if (mapper_) text += problem_text("mapper", mapper_->store_problem);
  if (segmenter_) text += problem_text("segmenter", segmenter_->problem);
  if (viewer_) text += problem_text("viewer", viewer_->problem);
  if (detector_) text += problem_text("detector", detector_->problem);
  return text;
}

}  // namespace kintsugi
