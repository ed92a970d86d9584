#include "lcmtypes/tools/status_text.hpp"

#include "lcmtypes/base/text_format.hpp"

namespace kintsugi {
namespace {

std::string count(std::int64_t value) {
  const auto real = static_cast<double>(value);
  if (value < 10'000) return std::to_string(value);
  if (value < 1'000'000) return format("%.0fk", real / 1e3);
  return format("%.2fM", real / 1e6);
}

std::string megabytes(std::int64_t bytes) {
  return format("%.0f MB", 1e-6 * static_cast<double>(bytes));
}

std::string state_text(TrackingState state) {
  if (state == TrackingState::kLost) return "LOST";
  return std::string(to_string(state)) + (state == TrackingState::kGiven ? " poses" : "");
}

/// For instance ", 5 lost"; empty when `value` is 0.
std::string some(std::int64_t value, const char* what) {
  return value > 0 ? ", " + count(value) + " " + what : std::string();
}

/// What a process has refused because of its key.
template <class Status>
std::string refused_text(const Status& status) {
  return some(status.messages_unsigned, "messages not signed") +
         some(status.messages_forged, "messages FORGED") +
         some(status.messages_replayed, "messages replayed");
}

/// What a receiver still lacks.
template <class Status>
std::string reception_text(const Status& status) {
  constexpr std::int64_t kNoticeable = 10'000'000;  // bytes
  std::string text = some(status.chunks_missing - status.chunks_given_up, "chunks asked for") +
                     some(status.chunks_given_up, "chunks MISSING") +
                     some(status.messages_bad, "bad messages") + refused_text(status);
  if (status.queue_bytes > kNoticeable) text += ", " + megabytes(status.queue_bytes) + " waiting";
  return text;
}

}  // namespace

std::string text_of(const MapperStatus& status) {
  std::string text = "frame " + std::to_string(status.frames_read);
  if (status.frames_total > 0) {
    text += format(
        "/%lld (%.0f %%)", static_cast<long long>(status.frames_total),
        100.0 * static_cast<double>(status.frames_read) / static_cast<double>(status.frames_total));
  }
  if (status.finished) {
    text += " mapped";
  } else {
    text += ' ';
    text += state_text(status.state);
    text += format(" %.1f Hz", status.frame_rate_hz);
  }
  if (status.parts > 1) text += format(", %d parts, in part %d", status.parts, status.part);
  if (!status.join.empty()) text += ", joins map '" + status.join + "'";
  if (status.guests > 0) {
    text += format(", %d guests with ", status.guests) + count(status.guest_patches) + " patches";
  }
  if (!status.finished && !status.loss_reason.empty()) text += " (" + status.loss_reason + ")";
  text += some(status.frames_lost, "lost") + some(status.frames_dropped, "dropped") +
          some(status.loops, "loops closed") + some(status.loops_contradicted, "contradicted") +
          some(status.corrections, "corrections") + " | " + count(status.slices_published) +
          " slices " + count(status.points_published) + " points";
  if (status.store_bytes > 0) text += ", store " + megabytes(status.store_bytes);
  if (!status.store_problem.empty()) {
    text += " (" + megabytes(status.store_waiting_bytes) + " NOT ON DISK)";
  }
  return text + some(status.store_lost_chunks, "chunks LOST") +
         some(status.chunks_resent, "resent") + refused_text(status);
}

std::string text_of(const SegmenterStatus& status) {
  std::string text = count(status.slices_segmented) + " segmented, ";
  if (status.slices_corrected > 0) text += count(status.slices_corrected) + " corrected, ";
  text += count(status.segments) + " segments, lag " + count(status.lag_slices) +
          format(", %.0f ms/slice", status.slice_mean_ms);
  if (status.maps > 1) text += ", " + count(status.maps) + " maps";
  return text + some(status.slices_missing, "slices MISSING") + reception_text(status) +
         some(status.states_sent, "full states sent");
}

std::string text_of(const ViewerStatus& status) {
  return count(status.snapshots_written) + " pictures, lag " + count(status.lag_slices) +
         reception_text(status);
}

std::string text_of(const DetectorStatus& status) {
  const std::int64_t there = status.detections_found + status.detections_confirmed;
  std::string text = count(there) + " detections of " + count(status.library_objects) + " objects";
  if (there > 0) text += " (" + count(status.detections_confirmed) + " confirmed)";
  return text + some(status.detections_gone, "gone") + ", lag " + count(status.lag_slices) +
         some(status.candidates_waiting, "candidates waiting") +
         format(", %.0f ms, %.0f %% of a core", status.lag_p50_ms, 100.0 * status.cpu_share) +
         some(status.library_refused, "objects REFUSED") + reception_text(status);
}

}  // namespace kintsugi
