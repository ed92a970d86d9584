#include "segmenter/process/process_status.hpp"

#include <fstream>

#include <unistd.h>

#include "lcmtypes/bus.hpp"

namespace kintsugi::segmenter {
namespace {

std::int64_t resident_memory_bytes() {
  std::ifstream statm("/proc/self/statm");
  std::int64_t total_pages = 0;
  std::int64_t resident_pages = 0;
  statm >> total_pages >> resident_pages;
  return resident_pages * sysconf(_SC_PAGESIZE);
}

}  // namespace

SegmenterStatus make_status(const SliceProcessor::Counts& counts, const StreamCounts& stream) {
  SegmenterStatus status;
  status.utime = wall_clock_us();
  status.map_session = counts.map_session;
  status.map_name = counts.map_name;
  status.slices_received = counts.received;
  status.slices_segmented = counts.segmented;
  status.slices_corrected = counts.corrected;
  status.slices_missing = counts.missing;
  status.lag_slices = counts.lag;
  status.points = counts.points;
  status.points_rejected = counts.rejected;
  status.segments = counts.segments;
  status.chunks_received = stream.chunks_received;
  status.chunks_duplicate = stream.chunks_duplicate;
  status.chunks_missing = stream.chunks_missing;
  status.messages_bad = stream.messages_bad + counts.dropped;
  status.memory_bytes = resident_memory_bytes();
  status.slice_ms = counts.slice_ms;
  status.slice_mean_ms = counts.slice_mean_ms;
  status.slice_max_ms = counts.slice_max_ms;
  return status;
}

}  // namespace kintsugi::segmenter
