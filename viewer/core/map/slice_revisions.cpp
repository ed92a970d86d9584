#include "viewer/core/map/slice_revisions.hpp"

#include <utility>

namespace kintsugi::viewer {

MapSlice* SliceRevisions::find(std::int32_t revision) {
  if (shown_.revision() == revision) return &shown_;
  for (MapSlice& slice : waiting_) {
    if (slice.revision() == revision) return &slice;
  }
  return nullptr;
}

void SliceRevisions::add(MapSlice newer) {
  if (waiting_.size() == kMaxWaiting) waiting_.erase(waiting_.begin());
  waiting_.push_back(std::move(newer));
}

std::optional<MapSlice> SliceRevisions::advance() {
  if (!shown_.was_labelled()) return advance_to_newest();
  for (std::size_t i = waiting_.size(); i-- > 0;) {
    if (waiting_[i].was_labelled()) return show(i);
  }
  return std::nullopt;
}

std::optional<MapSlice> SliceRevisions::advance_to_newest() {
  if (waiting_.empty()) return std::nullopt;
  return show(waiting_.size() - 1);
}

std::optional<MapSlice> SliceRevisions::show(std::size_t waiting) {
  const auto newly_shown = waiting_.begin() + static_cast<std::ptrdiff_t>(waiting);
  MapSlice replaced = std::exchange(shown_, std::move(*newly_shown));
  waiting_.erase(waiting_.begin(), newly_shown + 1);
  return replaced;
}

}  // namespace kintsugi::viewer
