#include "lcmtypes/tools/status_log.hpp"

#include <cerrno>
#include <cstring>
#include <initializer_list>
#include <stdexcept>
#include <string>

namespace kintsugi {
namespace {

/// As CSV has it: between double quotes, of which each inside is doubled.
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char letter : text) result += letter == '"' ? "\"\"" : std::string(1, letter);
  return result + '"';
}

/// A field of a status by its name on the bus.
struct Field {
  template <class Number>
  Field(const char* its_name, Number value) : name(its_name), text(std::to_string(value)) {}
  Field(const char* its_name, const std::string& value) : name(its_name), text(quoted(value)) {}

  const char* name;
  std::string text;
};

void write(std::ostream& out, std::int64_t utime, const char* process,
           std::initializer_list<Field> fields) {
  for (const Field& field : fields) {
    out << utime << ',' << process << ',' << field.name << ',' << field.text << '\n';
  }
  out.flush();
}

}  // namespace

StatusLog::StatusLog(const std::filesystem::path& path) : out_(path, std::ios::app) {
  if (out_ && out_.tellp() == 0) out_ << "utime_us,process,field,value" << std::endl;
  if (!out_) {
    throw std::runtime_error(path.string() + ": cannot be written: " + std::strerror(errno));
  }
}

void StatusLog::append(const MapperStatus& status) {
  write(out_, status.utime, "mapper",
        {{"session", status.session},
         {"finished", status.finished},
         {"lingering", status.lingering},
         {"frames_read", status.frames_read},
         {"frames_total", status.frames_total},
         {"frames_tracked", status.frames_tracked},
         {"frames_lost", status.frames_lost},
         {"frames_relocalised", status.frames_relocalised},
         {"frames_dropped", status.frames_dropped},
         {"frames_resumed", status.frames_resumed},
         {"keyframes", status.keyframes},
         {"undetermined", status.undetermined},
         {"slices_published", status.slices_published},
         {"points_published", status.points_published},
         {"chunks_published", status.chunks_published},
         {"chunks_resent", status.chunks_resent},
         {"requests_received", status.requests_received},
         {"store_bytes", status.store_bytes},
         {"store_waiting_bytes", status.store_waiting_bytes},
         {"store_lost_chunks", status.store_lost_chunks},
         {"store_problem", status.store_problem},
         {"blocks", status.blocks},
         {"memory_bytes", status.memory_bytes},
         {"volume_bytes", status.volume_bytes},
         {"queue_bytes", status.queue_bytes},
         {"frame_rate_hz", status.frame_rate_hz},
         {"frame_p50_ms", status.frame_p50_ms},
         {"frame_p99_ms", status.frame_p99_ms},
         {"cpu_ms", status.cpu_ms},
         {"read_ms", status.read_ms},
         {"convert_ms", status.convert_ms},
         {"prepare_ms", status.prepare_ms},
         {"track_ms", status.track_ms},
         {"shift_ms", status.shift_ms},
         {"integrate_ms", status.integrate_ms},
         {"raycast_ms", status.raycast_ms},
         {"extract_ms", status.extract_ms},
         {"publish_ms", status.publish_ms}});
}

void StatusLog::append(const SegmenterStatus& status) {
  write(out_, status.utime, "segmenter",
        {{"session", status.session},
         {"map_session", status.map_session},
         {"finished", status.finished},
         {"lingering", status.lingering},
         {"maps", status.maps},
         {"slices_received", status.slices_received},
         {"slices_segmented", status.slices_segmented},
         {"slices_corrected", status.slices_corrected},
         {"slices_missing", status.slices_missing},
         {"lag_slices", status.lag_slices},
         {"queue_bytes", status.queue_bytes},
         {"points", status.points},
         {"points_rejected", status.points_rejected},
         {"segments", status.segments},
         {"chunks_received", status.chunks_received},
         {"chunks_duplicate", status.chunks_duplicate},
         {"chunks_missing", status.chunks_missing},
         {"chunks_refused", status.chunks_refused},
         {"chunks_given_up", status.chunks_given_up},
         {"requests_sent", status.requests_sent},
         {"chunks_resent", status.chunks_resent},
         {"requests_received", status.requests_received},
         {"states_sent", status.states_sent},
         {"state_bytes", status.state_bytes},
         {"messages_bad", status.messages_bad},
         {"memory_bytes", status.memory_bytes},
         {"problem", status.problem},
         {"slice_ms", status.slice_ms},
         {"slice_mean_ms", status.slice_mean_ms},
         {"slice_max_ms", status.slice_max_ms}});
}

void StatusLog::append(const ViewerStatus& status) {
  write(out_, status.utime, "viewer",
        {{"session", status.session},
         {"map_session", status.map_session},
         {"finished", status.finished},
         {"slices_received", status.slices_received},
         {"updates_applied", status.updates_applied},
         {"lag_slices", status.lag_slices},
         {"queue_bytes", status.queue_bytes},
         {"points", status.points},
         {"segments", status.segments},
         {"snapshots_written", status.snapshots_written},
         {"chunks_missing", status.chunks_missing},
         {"chunks_refused", status.chunks_refused},
         {"chunks_given_up", status.chunks_given_up},
         {"requests_sent", status.requests_sent},
         {"messages_bad", status.messages_bad},
         {"memory_bytes", status.memory_bytes},
         {"problem", status.problem},
         {"render_ms", status.render_ms}});
}

}  // namespace kintsugi
