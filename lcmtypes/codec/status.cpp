// What a person watches.

#include <kintsugi/mapper_status_t.hpp>
#include <kintsugi/segmenter_status_t.hpp>
#include <kintsugi/viewer_status_t.hpp>

#include "lcmtypes/codec/small.hpp"

namespace kintsugi {
namespace codec {

template <>
struct Small<MapperStatus> : Copied<MapperStatus, mapper_status_t> {
  static constexpr int kNumStrings = 4;

  template <class From, class To>
  static void copy(const From& from, To& to) {
    to.utime = from.utime;
    to.session = from.session;
    to.state = static_cast<decltype(to.state)>(from.state);
    to.finished = from.finished != 0;
    to.lingering = from.lingering != 0;
    to.frames_read = from.frames_read;
    to.frames_total = from.frames_total;
    to.frames_tracked = from.frames_tracked;
    to.frames_lost = from.frames_lost;
    to.frames_relocalised = from.frames_relocalised;
    to.frames_dropped = from.frames_dropped;
    to.frames_resumed = from.frames_resumed;
    to.keyframes = from.keyframes;
    to.undetermined = from.undetermined;
    to.slices_published = from.slices_published;
    to.points_published = from.points_published;
    to.chunks_published = from.chunks_published;
    to.chunks_resent = from.chunks_resent;
    to.requests_received = from.requests_received;
    to.store_bytes = from.store_bytes;
    to.store_waiting_bytes = from.store_waiting_bytes;
    to.store_lost_chunks = from.store_lost_chunks;
    to.blocks = from.blocks;
    to.memory_bytes = from.memory_bytes;
    to.volume_bytes = from.volume_bytes;
    to.queue_bytes = from.queue_bytes;
    to.frame_rate_hz = from.frame_rate_hz;
    to.frame_p50_ms = from.frame_p50_ms;
    to.frame_p99_ms = from.frame_p99_ms;
    to.cpu_ms = from.cpu_ms;
    to.read_ms = from.read_ms;
    to.convert_ms = from.convert_ms;
    to.prepare_ms = from.prepare_ms;
    to.track_ms = from.track_ms;
    to.shift_ms = from.shift_ms;
    to.integrate_ms = from.integrate_ms;
    to.raycast_ms = from.raycast_ms;
    to.extract_ms = from.extract_ms;
    to.publish_ms = from.publish_ms;
    to.map_name = from.map_name;
    to.device = from.device;
    to.loss_reason = from.loss_reason;
    to.store_problem = from.store_problem;
  }
  static void check(const Check& check, const MapperStatus& m) {
    check.not_negative("utime", m.utime);
    check.positive("session", m.session);
    check_state(check, m.state);
    if (m.frames_total < -1) check.fail("frames_total", m.frames_total, ">= -1");
    check.range("undetermined", m.undetermined, 0, 6);
    check.not_negative("frames_read", m.frames_read);
    check.not_negative("frames_tracked", m.frames_tracked);
    check.not_negative("frames_lost", m.frames_lost);
    check.not_negative("frames_relocalised", m.frames_relocalised);
    check.not_negative("frames_dropped", m.frames_dropped);
    check.not_negative("frames_resumed", m.frames_resumed);
    check.not_negative("keyframes", m.keyframes);
    check.not_negative("slices_published", m.slices_published);
    check.not_negative("points_published", m.points_published);
    check.not_negative("chunks_published", m.chunks_published);
    check.not_negative("chunks_resent", m.chunks_resent);
    check.not_negative("requests_received", m.requests_received);
    check.not_negative("store_bytes", m.store_bytes);
    check.not_negative("store_waiting_bytes", m.store_waiting_bytes);
    check.not_negative("store_lost_chunks", m.store_lost_chunks);
    check.not_negative("blocks", m.blocks);
    check.not_negative("memory_bytes", m.memory_bytes);
    check.not_negative("volume_bytes", m.volume_bytes);
    check.not_negative("queue_bytes", m.queue_bytes);
    check.finite("frame_rate_hz", m.frame_rate_hz);
    check.finite("frame_p50_ms", m.frame_p50_ms);
    check.finite("frame_p99_ms", m.frame_p99_ms);
    check.finite("cpu_ms", m.cpu_ms);
    check.finite("read_ms", m.read_ms);
    check.finite("convert_ms", m.convert_ms);
    check.finite("prepare_ms", m.prepare_ms);
    check.finite("track_ms", m.track_ms);
    check.finite("shift_ms", m.shift_ms);
    check.finite("integrate_ms", m.integrate_ms);
    check.finite("raycast_ms", m.raycast_ms);
    check.finite("extract_ms", m.extract_ms);
    check.finite("publish_ms", m.publish_ms);
    check.text("map_name", m.map_name);
    check.text("device", m.device);
    check.text("loss_reason", m.loss_reason);
    check.text("store_problem", m.store_problem);
  }
};

template <>
struct Small<SegmenterStatus> : Copied<SegmenterStatus, segmenter_status_t> {
  static constexpr int kNumStrings = 3;

  template <class From, class To>
  static void copy(const From& from, To& to) {
    to.utime = from.utime;
    to.session = from.session;
    to.map_session = from.map_session;
    to.maps = from.maps;
    to.finished = from.finished != 0;
    to.lingering = from.lingering != 0;
    to.slices_received = from.slices_received;
    to.slices_segmented = from.slices_segmented;
    to.slices_corrected = from.slices_corrected;
    to.slices_missing = from.slices_missing;
    to.lag_slices = from.lag_slices;
    to.queue_bytes = from.queue_bytes;
    to.points = from.points;
    to.points_rejected = from.points_rejected;
    to.segments = from.segments;
    to.chunks_received = from.chunks_received;
    to.chunks_duplicate = from.chunks_duplicate;
    to.chunks_missing = from.chunks_missing;
    to.chunks_refused = from.chunks_refused;
    to.chunks_given_up = from.chunks_given_up;
    to.requests_sent = from.requests_sent;
    to.chunks_resent = from.chunks_resent;
    to.requests_received = from.requests_received;
    to.states_sent = from.states_sent;
    to.state_bytes = from.state_bytes;
    to.messages_bad = from.messages_bad;
    to.memory_bytes = from.memory_bytes;
    to.slice_ms = from.slice_ms;
    to.slice_mean_ms = from.slice_mean_ms;
    to.slice_max_ms = from.slice_max_ms;
    to.map_name = from.map_name;
    to.mode = from.mode;
    to.problem = from.problem;
  }
  static void check(const Check& check, const SegmenterStatus& m) {
    check.not_negative("utime", m.utime);
    check.positive("session", m.session);
    check.not_negative("map_session", m.map_session);
    check.not_negative("maps", m.maps);
    check.not_negative("slices_received", m.slices_received);
    check.not_negative("slices_segmented", m.slices_segmented);
    check.not_negative("slices_corrected", m.slices_corrected);
    check.not_negative("slices_missing", m.slices_missing);
    check.not_negative("lag_slices", m.lag_slices);
    check.not_negative("queue_bytes", m.queue_bytes);
    check.not_negative("points", m.points);
    check.not_negative("points_rejected", m.points_rejected);
    check.not_negative("segments", m.segments);
    check.not_negative("chunks_received", m.chunks_received);
    check.not_negative("chunks_duplicate", m.chunks_duplicate);
    check.not_negative("chunks_missing", m.chunks_missing);
    check.not_negative("chunks_refused", m.chunks_refused);
    check.not_negative("chunks_given_up", m.chunks_given_up);
    check.not_negative("requests_sent", m.requests_sent);
    check.not_negative("chunks_resent", m.chunks_resent);
    check.not_negative("requests_received", m.requests_received);
    check.not_negative("states_sent", m.states_sent);
    check.not_negative("state_bytes", m.state_bytes);
    check.not_negative("messages_bad", m.messages_bad);
    check.not_negative("memory_bytes", m.memory_bytes);
    check.finite("slice_ms", m.slice_ms);
    check.finite("slice_mean_ms", m.slice_mean_ms);
    check.finite("slice_max_ms", m.slice_max_ms);
    check.text("map_name", m.map_name);
    check.text("mode", m.mode);
    check.text("problem", m.problem);
  }
};

template <>
struct Small<ViewerStatus> : Copied<ViewerStatus, viewer_status_t> {
  static constexpr int kNumStrings = 2;

  template <class From, class To>
  static void copy(const From& from, To& to) {
    to.utime = from.utime;
    to.session = from.session;
    to.map_session = from.map_session;
    to.finished = from.finished != 0;
    to.slices_received = from.slices_received;
    to.updates_applied = from.updates_applied;
    to.lag_slices = from.lag_slices;
    to.queue_bytes = from.queue_bytes;
    to.points = from.points;
    to.segments = from.segments;
    to.snapshots_written = from.snapshots_written;
    to.chunks_missing = from.chunks_missing;
    to.chunks_refused = from.chunks_refused;
    to.chunks_given_up = from.chunks_given_up;
    to.requests_sent = from.requests_sent;
    to.messages_bad = from.messages_bad;
    to.memory_bytes = from.memory_bytes;
    to.render_ms = from.render_ms;
    to.map_name = from.map_name;
    to.problem = from.problem;
  }
  static void check(const Check& check, const ViewerStatus& m) {
    check.not_negative("utime", m.utime);
    check.positive("session", m.session);
    check.not_negative("map_session", m.map_session);
    check.not_negative("slices_received", m.slices_received);
    check.not_negative("updates_applied", m.updates_applied);
    check.not_negative("lag_slices", m.lag_slices);
    check.not_negative("queue_bytes", m.queue_bytes);
    check.not_negative("points", m.points);
    check.not_negative("segments", m.segments);
    check.not_negative("snapshots_written", m.snapshots_written);
    check.not_negative("chunks_missing", m.chunks_missing);
    check.not_negative("chunks_refused", m.chunks_refused);
    check.not_negative("chunks_given_up", m.chunks_given_up);
    check.not_negative("requests_sent", m.requests_sent);
    check.not_negative("messages_bad", m.messages_bad);
    check.not_negative("memory_bytes", m.memory_bytes);
    check.finite("render_ms", m.render_ms);
    check.text("map_name", m.map_name);
    check.text("problem", m.problem);
  }
};

}  // namespace codec

template Bytes encode(const MapperStatus&);
template MapperStatus decode(ByteView);
template Bytes encode(const SegmenterStatus&);
template SegmenterStatus decode(ByteView);
template Bytes encode(const ViewerStatus&);
template ViewerStatus decode(ByteView);

}  // namespace kintsugi
