#include "segmenter/process/process_status.hpp"

#include "lcmtypes/base/process_memory.hpp"
#include "lcmtypes/bus/bus.hpp"

namespace kintsugi::segmenter {

SegmenterStatus make_status(const SessionMaps::Counts& maps, const StreamCounts& slices,
                            const UpdatePublisher::Counts& updates) {
  const SessionMap::Counts& map = maps.newest;
  SegmenterStatus status;
  status.utime = wall_clock_us();
  status.map_session = map.map_session;
  status.map_name = map.map_name;
  status.maps = maps.maps;
  status.slices_received = map.received;
  status.slices_segmented = map.segmented;
  status.slices_corrected = map.corrected;
  status.slices_missing = maps.missing;
  status.lag_slices = maps.lag;
  status.points = map.points;
  status.points_rejected = map.rejected;
  status.segments = map.segments;
  status.chunks_received = slices.chunks_received;
  status.chunks_duplicate = slices.chunks_duplicate;
  status.chunks_missing = slices.chunks_missing;
  status.chunks_refused = slices.chunks_refused;
  status.chunks_given_up = slices.chunks_given_up;
  status.requests_sent = slices.requests_sent;
  status.chunks_resent = updates.stream.chunks_resent;
  status.requests_received = updates.stream.requests_received;
  status.states_sent = updates.states;
  status.state_bytes = updates.state_bytes;
  status.messages_bad = slices.messages_bad + updates.stream.requests_bad + maps.dropped;
  status.memory_bytes = process_memory().resident_bytes;
  status.slice_ms = map.slice_ms;
  status.slice_mean_ms = map.slice_mean_ms;
  status.slice_max_ms = map.slice_max_ms;
  return status;
}

}  // namespace kintsugi::segmenter
