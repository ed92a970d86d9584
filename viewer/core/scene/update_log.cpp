#include "viewer/core/scene/update_log.hpp"

#include <algorithm>
#include <limits>
#include <utility>

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
  memory_bytes_ += static_cast<std::int64_t>(sizeof(std::pair<const Key, Entry>) +
                                             entry.events.size() * sizeof(SegmentEvent) +
                                             entry.sizes.size() * sizeof(Size));
}

std::vector<const UpdateLog::Entry*> UpdateLog::entries() const {
  std::vector<const Entry*> newest_first;
  newest_first.reserve(entries_.size());
  std::int64_t session = 0;
  std::int32_t end_of_this = std::numeric_limits<std::int32_t>::max();  // where later ones begin
  std::int32_t begin_of_this = end_of_this;
  for (auto it = entries_.rbegin(); it != entries_.rend(); ++it) {
    const auto& [key, entry] = *it;
    if (key.session != session) end_of_this = begin_of_this;
    session = key.session;
    // A full state, which has no events, says nothing of how its last slice came about.
    const std::int32_t begin = entry.num_slices + (entry.events.empty() ? 1 : 0);
    begin_of_this = std::min(begin_of_this, begin);
    if (entry.num_slices < end_of_this) newest_first.push_back(&entry);
  }
  std::ranges::reverse(newest_first);
  return newest_first;
}

}  // namespace kintsugi::viewer
