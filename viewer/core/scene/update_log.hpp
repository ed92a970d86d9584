#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi::viewer {

/// What the updates of one map said about its segments, in their order, whatever the order they
/// came in: events, and the points of every segment that changed.
///
/// A segmenter that is started again goes on with the map that it has saved. What the one before
/// said of later slices is superseded: the new one says it again.
class UpdateLog {
 public:
  struct Size {
    std::uint32_t segment_id = 0;
    std::uint32_t num_points = 0;
  };
  struct Entry {
    std::int32_t num_slices = 0;  ///< in the map after this update
    std::vector<SegmentEvent> events;
    std::vector<Size> sizes;  ///< of segments that changed, or of all of them: a full state
  };

  /// An update that is here already says nothing new.
  void add(const SegmentUpdate& update);

  /// What has not been superseded, in the order of the updates.
  [[nodiscard]] std::vector<const Entry*> entries() const;

  std::int64_t memory_bytes() const { return memory_bytes_; }

 private:
  struct Key {
    std::int64_t session = 0;
    std::int64_t sequence = 0;

    auto operator<=>(const Key&) const = default;
  };

  std::map<Key, Entry> entries_;
  std::int64_t memory_bytes_ = 0;
};

}  // namespace kintsugi::viewer
