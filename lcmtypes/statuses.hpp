#pragma once
// What each process reports of itself once to several times a second. The meaning of each field is
// in kintsugi_mapper_status_t.lcm, kintsugi_segmenter_status_t.lcm, kintsugi_viewer_status_t.lcm
// and kintsugi_detector_status_t.lcm; its unit is the end of its name, counts have none.
//
// visit_fields() is the only list of the fields in C++: the codec, its checks, StatusLog and the
// examples of the tests use it. A field that is missing from the struct, from the list or from the
// .lcm file does not compile (codec/status.cpp); one that stands elsewhere in one of the three, or
// under another name, fails a test.

#include <cstdint>
#include <limits>
#include <string>

#include "lcmtypes/tracking_state.hpp"

namespace kintsugi {

/// The highest value of a field without an upper bound.
inline constexpr std::int64_t kNoUpperBound = std::numeric_limits<std::int64_t>::max();

/// A field of a status: its name on the bus, and the bounds of its value if that is an integer.
/// A double must be finite, a text must have no control characters.
struct StatusField {
  // Implicit, so that a field with the usual bounds is named by its name alone.
  constexpr StatusField(  // NOLINT(google-explicit-constructor)
      const char* field_name, std::int64_t lowest_value = 0,
      std::int64_t highest_value = kNoUpperBound)
      : name(field_name), lowest(lowest_value), highest(highest_value) {}

  const char* name;
  std::int64_t lowest;
  std::int64_t highest;
};

/// What the mapper reports.
struct MapperStatus {
  static constexpr char kProcess[] = "mapper";

  std::int64_t utime = 0;
  std::int64_t session = 0;
  std::int32_t part = 0;
  std::int32_t parts = 1;
  TrackingState state = TrackingState::kStarting;
  bool finished = false;
  bool lingering = false;
  std::int64_t frames_read = 0;
  std::int64_t frames_total = -1;
  std::int64_t frames_tracked = 0;
  std::int64_t frames_lost = 0;
  std::int64_t frames_relocalised = 0;
  std::int64_t frames_dropped = 0;
  std::int64_t frames_resumed = 0;
  std::int64_t keyframes = 0;
  std::int64_t loops = 0;
  std::int64_t loops_contradicted = 0;
  std::int64_t corrections = 0;
  std::int32_t guests = 0;
  std::int64_t guest_patches = 0;
  std::int32_t undetermined = 0;
  std::int64_t slices_published = 0;
  std::int64_t points_published = 0;
  std::int64_t chunks_published = 0;
  std::int64_t patches_superseded = 0;
  std::int64_t chunks_resent = 0;
  std::int64_t requests_received = 0;
  std::int64_t messages_unsigned = 0;
  std::int64_t messages_forged = 0;
  std::int64_t messages_replayed = 0;
  std::int64_t store_bytes = 0;
  std::int64_t store_waiting_bytes = 0;
  std::int64_t store_lost_chunks = 0;
  std::int64_t blocks = 0;
  std::int64_t memory_bytes = 0;
  std::int64_t volume_bytes = 0;
  std::int64_t queue_bytes = 0;
  double noise_base_m = 0.0;
  double noise_share = 0.0;
  double noise_growth_per_m = 0.0;
  double frame_rate_hz = 0.0;
  double frame_p50_ms = 0.0;
  double frame_p99_ms = 0.0;
  double cpu_ms = 0.0;
  double read_ms = 0.0;
  double convert_ms = 0.0;
  double prepare_ms = 0.0;
  double track_ms = 0.0;
  double shift_ms = 0.0;
  double integrate_ms = 0.0;
  double raycast_ms = 0.0;
  double extract_ms = 0.0;
  double publish_ms = 0.0;
  std::string map_name;
  std::string join;
  std::string device;
  std::string loss_reason;
  std::string store_problem;

  bool operator==(const MapperStatus&) const = default;

  /// Calls visit(StatusField, the field of each of `s`...) for every field, in the order of the
  /// .lcm file. Each of `s` is a status of this type, or its LCM type.
  template <class Visit, class... Statuses>
  static constexpr void visit_fields(const Visit& visit, Statuses&... s) {
    visit("utime", s.utime...);
    visit({"session", 1}, s.session...);
    visit("part", s.part...);
    visit({"parts", 1}, s.parts...);
    visit("state", s.state...);
    visit("finished", s.finished...);
    visit("lingering", s.lingering...);
    visit("frames_read", s.frames_read...);
    visit({"frames_total", -1}, s.frames_total...);
    visit("frames_tracked", s.frames_tracked...);
    visit("frames_lost", s.frames_lost...);
    visit("frames_relocalised", s.frames_relocalised...);
    visit("frames_dropped", s.frames_dropped...);
    visit("frames_resumed", s.frames_resumed...);
    visit("keyframes", s.keyframes...);
    visit("loops", s.loops...);
    visit("loops_contradicted", s.loops_contradicted...);
    visit("corrections", s.corrections...);
    visit("guests", s.guests...);
    visit("guest_patches", s.guest_patches...);
    visit({"undetermined", 0, 6}, s.undetermined...);
    visit("slices_published", s.slices_published...);
    visit("points_published", s.points_published...);
    visit("chunks_published", s.chunks_published...);
    visit("patches_superseded", s.patches_superseded...);
    visit("chunks_resent", s.chunks_resent...);
    visit("requests_received", s.requests_received...);
    visit("messages_unsigned", s.messages_unsigned...);
    visit("messages_forged", s.messages_forged...);
    visit("messages_replayed", s.messages_replayed...);
    visit("store_bytes", s.store_bytes...);
    visit("store_waiting_bytes", s.store_waiting_bytes...);
    visit("store_lost_chunks", s.store_lost_chunks...);
    visit("blocks", s.blocks...);
    visit("memory_bytes", s.memory_bytes...);
    visit("volume_bytes", s.volume_bytes...);
    visit("queue_bytes", s.queue_bytes...);
    visit("noise_base_m", s.noise_base_m...);
    visit("noise_share", s.noise_share...);
    visit("noise_growth_per_m", s.noise_growth_per_m...);
    visit("frame_rate_hz", s.frame_rate_hz...);
    visit("frame_p50_ms", s.frame_p50_ms...);
    visit("frame_p99_ms", s.frame_p99_ms...);
    visit("cpu_ms", s.cpu_ms...);
    visit("read_ms", s.read_ms...);
    visit("convert_ms", s.convert_ms...);
    visit("prepare_ms", s.prepare_ms...);
    visit("track_ms", s.track_ms...);
    visit("shift_ms", s.shift_ms...);
    visit("integrate_ms", s.integrate_ms...);
    visit("raycast_ms", s.raycast_ms...);
    visit("extract_ms", s.extract_ms...);
    visit("publish_ms", s.publish_ms...);
    visit("map_name", s.map_name...);
    visit("join", s.join...);
    visit("device", s.device...);
    visit("loss_reason", s.loss_reason...);
    visit("store_problem", s.store_problem...);
  }
};

/// What the segmenter reports.
struct SegmenterStatus {
  static constexpr char kProcess[] = "segmenter";

  std::int64_t utime = 0;
  std::int64_t session = 0;
  std::int64_t map_session = 0;
  bool finished = false;
  bool lingering = false;
  std::int64_t maps = 0;
  std::int64_t slices_received = 0;
  std::int64_t slices_segmented = 0;
  std::int64_t slices_corrected = 0;
  std::int64_t slices_missing = 0;
  std::int64_t lag_slices = 0;
  std::int64_t queue_bytes = 0;
  std::int64_t points = 0;
  std::int64_t points_rejected = 0;
  std::int64_t segments = 0;
  std::int64_t chunks_received = 0;
  std::int64_t chunks_duplicate = 0;
  std::int64_t chunks_missing = 0;
  std::int64_t chunks_refused = 0;
  std::int64_t chunks_given_up = 0;
  std::int64_t requests_sent = 0;
  std::int64_t chunks_resent = 0;
  std::int64_t requests_received = 0;
  std::int64_t states_sent = 0;
  std::int64_t state_bytes = 0;
  std::int64_t messages_bad = 0;
  std::int64_t messages_unsigned = 0;
  std::int64_t messages_forged = 0;
  std::int64_t messages_replayed = 0;
  std::int64_t memory_bytes = 0;
  double slice_ms = 0.0;
  double slice_mean_ms = 0.0;
  double slice_max_ms = 0.0;
  std::string map_name;
  std::string mode;
  std::string problem;

  bool operator==(const SegmenterStatus&) const = default;

  /// Calls visit(StatusField, the field of each of `s`...) for every field, in the order of the
  /// .lcm file. Each of `s` is a status of this type, or its LCM type.
  template <class Visit, class... Statuses>
  static constexpr void visit_fields(const Visit& visit, Statuses&... s) {
    visit("utime", s.utime...);
    visit({"session", 1}, s.session...);
    visit("map_session", s.map_session...);
    visit("finished", s.finished...);
    visit("lingering", s.lingering...);
    visit("maps", s.maps...);
    visit("slices_received", s.slices_received...);
    visit("slices_segmented", s.slices_segmented...);
    visit("slices_corrected", s.slices_corrected...);
    visit("slices_missing", s.slices_missing...);
    visit("lag_slices", s.lag_slices...);
    visit("queue_bytes", s.queue_bytes...);
    visit("points", s.points...);
    visit("points_rejected", s.points_rejected...);
    visit("segments", s.segments...);
    visit("chunks_received", s.chunks_received...);
    visit("chunks_duplicate", s.chunks_duplicate...);
    visit("chunks_missing", s.chunks_missing...);
    visit("chunks_refused", s.chunks_refused...);
    visit("chunks_given_up", s.chunks_given_up...);
    visit("requests_sent", s.requests_sent...);
    visit("chunks_resent", s.chunks_resent...);
    visit("requests_received", s.requests_received...);
    visit("states_sent", s.states_sent...);
    visit("state_bytes", s.state_bytes...);
    visit("messages_bad", s.messages_bad...);
    visit("messages_unsigned", s.messages_unsigned...);
    visit("messages_forged", s.messages_forged...);
    visit("messages_replayed", s.messages_replayed...);
    visit("memory_bytes", s.memory_bytes...);
    visit("slice_ms", s.slice_ms...);
    visit("slice_mean_ms", s.slice_mean_ms...);
    visit("slice_max_ms", s.slice_max_ms...);
    visit("map_name", s.map_name...);
    visit("mode", s.mode...);
    visit("problem", s.problem...);
  }
};

/// What the viewer reports.
struct ViewerStatus {
  static constexpr char kProcess[] = "viewer";

  std::int64_t utime = 0;
  std::int64_t session = 0;
  std::int64_t map_session = 0;
  bool finished = false;
  std::int64_t slices_received = 0;
  std::int64_t updates_applied = 0;
  std::int64_t lag_slices = 0;
  std::int64_t queue_bytes = 0;
  std::int64_t points = 0;
  std::int64_t segments = 0;
  std::int64_t snapshots_written = 0;
  std::int64_t chunks_missing = 0;
  std::int64_t chunks_refused = 0;
  std::int64_t chunks_given_up = 0;
  std::int64_t requests_sent = 0;
  std::int64_t messages_bad = 0;
  std::int64_t messages_unsigned = 0;
  std::int64_t messages_forged = 0;
  std::int64_t messages_replayed = 0;
  std::int64_t memory_bytes = 0;
  double render_ms = 0.0;
  std::string map_name;
  std::string problem;

  bool operator==(const ViewerStatus&) const = default;

  /// Calls visit(StatusField, the field of each of `s`...) for every field, in the order of the
  /// .lcm file. Each of `s` is a status of this type, or its LCM type.
  template <class Visit, class... Statuses>
  static constexpr void visit_fields(const Visit& visit, Statuses&... s) {
    visit("utime", s.utime...);
    visit({"session", 1}, s.session...);
    visit("map_session", s.map_session...);
    visit("finished", s.finished...);
    visit("slices_received", s.slices_received...);
    visit("updates_applied", s.updates_applied...);
    visit("lag_slices", s.lag_slices...);
    visit("queue_bytes", s.queue_bytes...);
    visit("points", s.points...);
    visit("segments", s.segments...);
    visit("snapshots_written", s.snapshots_written...);
    visit("chunks_missing", s.chunks_missing...);
    visit("chunks_refused", s.chunks_refused...);
    visit("chunks_given_up", s.chunks_given_up...);
    visit("requests_sent", s.requests_sent...);
    visit("messages_bad", s.messages_bad...);
    visit("messages_unsigned", s.messages_unsigned...);
    visit("messages_forged", s.messages_forged...);
    visit("messages_replayed", s.messages_replayed...);
    visit("memory_bytes", s.memory_bytes...);
    visit("render_ms", s.render_ms...);
    visit("map_name", s.map_name...);
    visit("problem", s.problem...);
  }
};

/// What the detector of objects reports.
struct DetectorStatus {
  static constexpr char kProcess[] = "detector";

  std::int64_t utime = 0;
  std::int64_t session = 0;
  std::int64_t map_session = 0;
  bool finished = false;
  std::int64_t library_objects = 0;
  std::int64_t library_refused = 0;
  std::int64_t updates_applied = 0;
  std::int64_t lag_slices = 0;
  std::int64_t queue_bytes = 0;
  std::int64_t points = 0;
  std::int64_t segments = 0;
  std::int64_t candidates_waiting = 0;
  std::int64_t candidates_examined = 0;
  std::int64_t detections_found = 0;
  std::int64_t detections_confirmed = 0;
  std::int64_t detections_gone = 0;
  std::int64_t events = 0;
  std::int64_t chunks_missing = 0;
  std::int64_t chunks_refused = 0;
  std::int64_t chunks_given_up = 0;
  std::int64_t requests_sent = 0;
  std::int64_t messages_bad = 0;
  std::int64_t messages_unsigned = 0;
  std::int64_t messages_forged = 0;
  std::int64_t messages_replayed = 0;
  std::int64_t memory_bytes = 0;
  double lag_p50_ms = 0.0;
  double lag_max_ms = 0.0;
  double cpu_share = 0.0;
  double worst_burst_ms = 0.0;
  std::string map_name;
  std::string library;
  std::string problem;

  bool operator==(const DetectorStatus&) const = default;

  /// Calls visit(StatusField, the field of each of `s`...) for every field, in the order of the
  /// .lcm file. Each of `s` is a status of this type, or its LCM type.
  template <class Visit, class... Statuses>
  static constexpr void visit_fields(const Visit& visit, Statuses&... s) {
    visit("utime", s.utime...);
    visit({"session", 1}, s.session...);
    visit("map_session", s.map_session...);
    visit("finished", s.finished...);
    visit("library_objects", s.library_objects...);
    visit("library_refused", s.library_refused...);
    visit("updates_applied", s.updates_applied...);
    visit("lag_slices", s.lag_slices...);
    visit("queue_bytes", s.queue_bytes...);
    visit("points", s.points...);
    visit("segments", s.segments...);
    visit("candidates_waiting", s.candidates_waiting...);
    visit("candidates_examined", s.candidates_examined...);
    visit("detections_found", s.detections_found...);
    visit("detections_confirmed", s.detections_confirmed...);
    visit("detections_gone", s.detections_gone...);
    visit("events", s.events...);
    visit("chunks_missing", s.chunks_missing...);
    visit("chunks_refused", s.chunks_refused...);
    visit("chunks_given_up", s.chunks_given_up...);
    visit("requests_sent", s.requests_sent...);
    visit("messages_bad", s.messages_bad...);
    visit("messages_unsigned", s.messages_unsigned...);
    visit("messages_forged", s.messages_forged...);
    visit("messages_replayed", s.messages_replayed...);
    visit("memory_bytes", s.memory_bytes...);
    visit("lag_p50_ms", s.lag_p50_ms...);
    visit("lag_max_ms", s.lag_max_ms...);
    visit("cpu_share", s.cpu_share...);
    visit("worst_burst_ms", s.worst_burst_ms...);
    visit("map_name", s.map_name...);
    visit("library", s.library...);
    visit("problem", s.problem...);
  }
};

}  // namespace kintsugi
