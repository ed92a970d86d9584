#include "viewer/core/map/update_log.hpp"

#include <algorithm>
#include <limits>

namespace kintsugi::viewer {

void UpdateLog::add(const SegmentUpdate& update) {
  if (update.events.empty() && update.statistics.empty()) return;
  const auto [place, is_new] = entries_.try_emplace({update.session, update.sequence});
  if (!is_new) return;
  Entry& entry = place->second;
  entry.num_slices = update.num_slices;
  entry.events = update.events;
  entry.sizes.reserve(update.statistics.size());
  for (const SegmentStatistics& segment : update.statistics) {
    entry.sizes.push_back({segment.segment_id, segment.num_points});
  }
}

std::vector<const UpdateLog::Entry*> UpdateLog::entries() const {
  std::vector<const Entry*> newest_first;
  newest_first.reserve(entries_.size());
  std::int64_t session = 0;
  // Slice counts at which this session and the one after it begin; later counts are superseded.
  std::int32_t next_session_begin = std::numeric_limits<std::int32_t>::max();
  std::int32_t session_begin = next_session_begin;
  for (auto it = entries_.rbegin(); it != entries_.rend(); ++it) {
    const auto& [key, entry] = *it;
    if (key.session != session) next_session_begin = session_begin;
    session = key.session;
    // A full state has no events: those of its last slice remain from the session before.
    const std::int32_t begin = entry.num_slices + (entry.events.empty() ? 1 : 0);
    session_begin = std::min(session_begin, begin);
    if (entry.num_slices < next_session_begin) newest_first.push_back(&entry);
  }
  std::ranges::reverse(newest_first);
  return newest_first;
}

}  // namespace kintsugi::viewer
