#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi::viewer {

/// Names one version of the points of a slice.
struct SliceKey {
  std::int32_t id = 0;
  std::int32_t revision = 0;

  bool operator<(const SliceKey& other) const {
    return std::tie(id, revision) < std::tie(other.id, other.revision);
  }
};

/// What updates said about revisions of slices that are not here yet. Bounded by bytes whatever the
/// slices are that updates name: a segmenter that goes wrong fills no memory.
class PendingUpdates {
 public:
  struct Labels {
    std::vector<std::uint32_t> labels;
    std::uint32_t number = 0;  ///< of the update
  };
  struct Run {
    LabelRun run;
    std::uint32_t number = 0;  ///< of the update
  };
  struct Entry {
    std::optional<Labels> labels;
    std::vector<Run> runs;
  };
  enum class Outcome {
    kNews,
    kKnown,   ///< the same labels, or newer ones, wait already
    kNoRoom,  ///< not kept
  };

  explicit PendingUpdates(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  Outcome add(SliceKey key, Labels labels);
  /// False when there is no room.
  bool add(const Run& run);

  /// Removes what waits for this revision of a slice and for earlier ones, and hands each out, the
  /// earliest first.
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

  /// Slices of which labels wait and `function(id)` holds.
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
