#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "viewer/core/map/label_update.hpp"

namespace kintsugi::viewer {

/// Labels and runs for revisions of slices that have not arrived yet. Its memory is bounded
/// whatever slices the updates name, so that a faulty segmenter cannot fill it.
class PendingUpdates {
 public:
  struct Entry {
    std::optional<NumberedLabels> labels;
    std::vector<NumberedRun> runs;
  };

  explicit PendingUpdates(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  /// kNothingNew when the same labels, or those of a later update, are waiting already; kNotUsable
  /// when there is no room.
  UpdateEffect add(SliceKey key, NumberedLabels labels);
  /// False when there is no room.
  bool add(const NumberedRun& run);

  /// Removes the entries of this revision of a slice and of earlier ones, and calls
  /// function(key, entry) for each, the earliest first.
  template <class Function>
  void take_up_to(SliceKey key, Function&& function) {
    const auto end = entries_.upper_bound(key);
    for (auto it = entries_.lower_bound({key.id, std::numeric_limits<std::int32_t>::min()});
         it != end; it = entries_.erase(it)) {
      bytes_ -= bytes_of(it->second);
      function(it->first, it->second);
    }
  }

  void clear();

  /// Number of slices with waiting labels for which `function(id)` holds.
  template <class Function>
  std::int64_t count_labelled_if(Function&& function) const {
    std::int64_t count = 0;
    std::optional<std::int32_t> counted_id;
    for (const auto& [key, entry] : entries_) {
      if (!entry.labels || counted_id == key.id || !function(key.id)) continue;
      counted_id = key.id;
      ++count;
    }
    return count;
  }

  std::size_t bytes() const { return bytes_; }

 private:
  static std::size_t bytes_of(const Entry& entry);
  Entry* find_or_make(SliceKey key, std::size_t more_bytes);

  std::size_t max_bytes_;
  std::size_t bytes_ = 0;
  std::map<SliceKey, Entry> entries_;
};

}  // namespace kintsugi::viewer
