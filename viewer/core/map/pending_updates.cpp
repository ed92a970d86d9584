#include "viewer/core/map/pending_updates.hpp"

#include <utility>

namespace kintsugi::viewer {

/// Counts a node of the map, but not the unused capacity of vectors.
std::size_t PendingUpdates::bytes_of(const Entry& entry) {
  constexpr std::size_t kNode = sizeof(std::pair<const SliceKey, Entry>) + 4 * sizeof(void*);
  return kNode + entry.runs.size() * sizeof(NumberedRun) +
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

UpdateEffect PendingUpdates::add(SliceKey key, NumberedLabels labels) {
  if (const auto found = entries_.find(key); found != entries_.end() && found->second.labels) {
    NumberedLabels& waiting = *found->second.labels;
    if (waiting.number > labels.number) return UpdateEffect::kNothingNew;
    if (waiting.labels == labels.labels) {
      waiting.number = labels.number;
      return UpdateEffect::kNothingNew;
    }
    bytes_ -= waiting.labels.size() * sizeof(std::uint32_t);
    found->second.labels.reset();
  }
  Entry* const entry = find_or_make(key, labels.labels.size() * sizeof(std::uint32_t));
  if (entry == nullptr) return UpdateEffect::kNotUsable;
  entry->labels = std::move(labels);
  return UpdateEffect::kChanged;
}

bool PendingUpdates::add(const NumberedRun& run) {
  Entry* const entry =
      find_or_make({run.run.slice_id, run.run.slice_revision}, sizeof(NumberedRun));
  if (entry != nullptr) entry->runs.push_back(run);
  return entry != nullptr;
}

void PendingUpdates::clear() {
  entries_.clear();
  bytes_ = 0;
}

}  // namespace kintsugi::viewer
