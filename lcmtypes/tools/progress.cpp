#include "lcmtypes/tools/progress.hpp"

#include <cmath>
#include <cstdio>

namespace kintsugi {
namespace {

// Statuses come about once a second; a process that misses five has a problem.
constexpr double kSilence_s = 5.0;

template <class... Values>
std::string format(const char* pattern, Values... values) {
  char text[256];
  std::snprintf(text, sizeof(text), pattern, values...);
  return text;
}

std::string count(std::int64_t value) {
  const auto real = static_cast<double>(value);
  if (value < 10'000) return std::to_string(value);
  if (value < 1'000'000) return format("%.0fk", real / 1e3);
  return format("%.2fM", real / 1e6);
}

const char* name(TrackingState state) {
  switch (state) {
    case TrackingState::kStarting:
      return "starting";
    case TrackingState::kTracking:
      return "tracking";
    case TrackingState::kLost:
      return "LOST";
    case TrackingState::kGiven:
      return "given poses";
  }
  return "?";
}

}  // namespace

void Progress::update(const MapperStatus& status, std::int64_t now_us) {
  mapper_ = status;
  note_progress(now_us);
}

void Progress::update(const SegmenterStatus& status, std::int64_t now_us) {
  segmenter_ = status;
  note_progress(now_us);
}

void Progress::update(const ViewerStatus& status, std::int64_t now_us) {
  viewer_ = status;
  note_progress(now_us);
}

bool Progress::finished(bool with_viewer) const { return unfinished(with_viewer).empty(); }

std::string Progress::unfinished(bool with_viewer) const {
  std::string names;
  const auto add = [&names](const char* process, const char* why) {
    names += std::string(names.empty() ? "" : ", ") + process + " " + why;
  };
  if (!mapper_) {
    add("mapper", "not heard of");
  } else if (!mapper_->finished) {
    add("mapper", "not finished");
  }
  if (!segmenter_) {
    add("segmenter", "not heard of");
  } else if (!segmenter_->finished) {
    add("segmenter", "not finished");
  } else if (mapper_ && segmenter_->map_session != mapper_->session) {
    add("segmenter", "finished another map");
  }
  if (with_viewer && !viewer_) {
    add("viewer", "not heard of");
  } else if (with_viewer && !viewer_->finished) {
    add("viewer", "not finished");
  }
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
  return sum;
}

void Progress::note_progress(std::int64_t now_us) {
  last_heard_us_ = now_us;
  const std::int64_t work = work_done();
  // Less than before is progress too: a process was started again.
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
    // What waits now is segmented while the mapper goes on, or after it.
    left_s = std::max(
        left_s, static_cast<double>(segmenter_->lag_slices) * segmenter_->slice_mean_ms / 1000.0);
  }
  return std::max(left_s, 0.0);
}

std::string Progress::line(std::int64_t now_us) const {
  if (!heard_anything()) return "waiting: nothing heard on the bus yet";
  std::string text = mapper_text() + " | " + segmenter_text();
  if (viewer_) text += " | " + viewer_text();
  const double silence_s = static_cast<double>(now_us - last_heard_us_) / 1e6;
  if (silence_s > kSilence_s) return text + format(" | silent for %.0f s", silence_s);
  if (finished(viewer_.has_value())) return text + " | finished";
  if (const auto left_s = time_left_s()) {
    const auto seconds = static_cast<long>(std::ceil(*left_s));
    text += format(" | %ld:%02ld left", seconds / 60, seconds % 60);
  }
  return text;
}

std::string Progress::mapper_text() const {
  if (!mapper_) return "no mapper";
  const MapperStatus& m = *mapper_;
  std::string text = "frame " + std::to_string(m.frames_read);
  if (m.frames_total > 0) {
    text +=
        format("/%lld (%.0f %%)", static_cast<long long>(m.frames_total),
               100.0 * static_cast<double>(m.frames_read) / static_cast<double>(m.frames_total));
  }
  text +=
      m.finished ? std::string(" mapped") : format(" %s %.1f Hz", name(m.state), m.frame_rate_hz);
  if (!m.finished && !m.loss_reason.empty()) text += " (" + m.loss_reason + ")";
  if (m.frames_lost > 0) text += ", " + count(m.frames_lost) + " lost";
  if (m.frames_dropped > 0) text += ", " + count(m.frames_dropped) + " dropped";
  return text + " | " + count(m.slices_published) + " slices " + count(m.points_published) +
         " points";
}

std::string Progress::segmenter_text() const {
  if (!segmenter_) return "no segmenter";
  const SegmenterStatus& s = *segmenter_;
  std::string text = count(s.slices_segmented) + " segmented, ";
  if (s.slices_corrected > 0) text += count(s.slices_corrected) + " corrected, ";
  text += count(s.segments) + " segments, lag " + count(s.lag_slices) +
          format(", %.0f ms/slice", s.slice_mean_ms);
  if (s.slices_missing > 0) text += ", " + count(s.slices_missing) + " slices MISSING";
  if (s.chunks_missing > 0) text += ", " + count(s.chunks_missing) + " chunks MISSING";
  if (s.messages_bad > 0) text += ", " + count(s.messages_bad) + " bad messages";
  return text;
}

std::string Progress::viewer_text() const {
  const ViewerStatus& v = *viewer_;
  std::string text = count(v.snapshots_written) + " pictures, lag " + count(v.lag_slices);
  if (v.chunks_missing > 0) text += ", " + count(v.chunks_missing) + " chunks MISSING";
  return text;
}

}  // namespace kintsugi
