#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi::viewer {

/// Segment events and sizes from the updates of one map, in the order of the updates, whatever
/// order they arrive in.
///
/// A segmenter that is restarted continues with the map that it saved last. Updates of its
/// predecessor for slices after that are superseded: the new segmenter sends them again.
class UpdateLog {
 public:
  struct Size {
    std::uint32_t segment_id = 0;
    std::uint32_t num_points = 0;
  };
  struct Entry {
    std::int32_t num_slices = 0;  ///< in the map after this update
    std::vector<SegmentEvent> events;
    std::vector<Size> sizes;  ///< of segments that changed; in a full state, of all segments
  };

  /// An update that has been added already is ignored.
  void add(const SegmentUpdate& update);

  /// The entries that have not been superseded, in the order of the updates.
  std::vector<const Entry*> entries() const;

 private:
  struct Key {
    std::int64_t session = 0;
    std::int64_t sequence = 0;

    auto operator<=>(const Key&) const = default;
  };

  std::map<Key, Entry> entries_;
};

}  // namespace kintsugi::viewer
