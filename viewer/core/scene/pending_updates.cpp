#include "viewer/core/scene/pending_updates.hpp"

#include <utility>

namespace kintsugi::viewer {

/// Without slack of the vectors, but with that of a node of the map.
std::size_t PendingUpdates::bytes_of(const Entry& entry) {
  constexpr std::size_t kNode = sizeof(std::pair<const SliceKey, Entry>) + 4 * sizeof(void*);
  return kNode + entry.runs.size() * sizeof(Run) +
         (entry.labels ? entry.labels->labels.size() * sizeof(std::uint32_t) : 0);
}

/// The entry of a slice; nullptr when there is no room for it and `more_bytes` in it.
PendingUpdates::Entry* PendingUpdates::find_or_make(SliceKey key, std::size_t more_bytes) {
  const auto found = entries_.find(key);
  const std::size_t needed = more_bytes + (found == entries_.end() ? bytes_of({}) : 0);
  if (bytes_ + needed > max_bytes_) return nullptr;
  bytes_ += needed;
  return found == entries_.end() ? &entries_[key] : &found->second;
}

PendingUpdates::Outcome PendingUpdates::add(SliceKey key, Labels labels) {
  if (const auto found = entries_.find(key); found != entries_.end() && found->second.labels) {
    Labels& waiting = *found->second.labels;
    if (waiting.number > labels.number) return Outcome::kKnown;
    if (waiting.labels == labels.labels) {
      waiting.number = labels.number;
      return Outcome::kKnown;
    }
    bytes_ -= waiting.labels.size() * sizeof(std::uint32_t);
    found->second.labels.reset();
  }
  Entry* const entry = find_or_make(key, labels.labels.size() * sizeof(std::uint32_t));
  if (entry == nullptr) return Outcome::kNoRoom;
  entry->labels = std::move(labels);
  return Outcome::kNews;
}

bool PendingUpdates::add(const Run& run) {
  Entry* const entry = find_or_make({run.run.slice_id, run.run.slice_revision}, sizeof(Run));
  if (entry != nullptr) entry->runs.push_back(run);
  return entry != nullptr;
}

void PendingUpdates::clear() {
  entries_.clear();
  bytes_ = 0;
}

}  // namespace kintsugi::viewer
