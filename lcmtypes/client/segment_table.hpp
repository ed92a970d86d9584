#pragma once
// The segments of a map as a client knows them from SEGMENT_UPDATE alone.

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>

#include "lcmtypes/messages.hpp"

namespace kintsugi {

/// True if the update has statistics of every segment of the map: the last update of a full state
/// has, and any other that changed all segments.
inline bool lists_all_segments(const SegmentUpdate& update) {
  return static_cast<std::int64_t>(update.statistics.size()) == update.num_segments;
}

/// The table of the segments of one map: its segments and their statistics, where each came from,
/// and what became of segments that no longer exist.
///
/// Updates may be applied in any order and repeatedly: the table depends only on the set of
/// updates. This relies on three guarantees of the segmenter: ids are never used again in its
/// session; one event tells of the birth and one of the death of each segment; an update has the
/// statistics of every segment that it changed, and they hold until a later update.
///
/// A table that lacks updates is correct again after the next update that lists all segments, for
/// instance the end of a full state, which a late listener receives. Segments that such an update
/// does not list no longer exist; there is no event for them.
///
/// The caller passes updates of one map only. The table has the newest session of it: an update of
/// a newer session of the mapper or the segmenter clears the table first, one of an older session
/// is ignored.
class SegmentTable {
 public:
  /// Where a segment came from.
  struct Origin {
    std::uint32_t parent_id = kNoSegment;  ///< it was split off this; kNoSegment: new points
    std::int64_t utime = 0;                ///< device time of the slice, microseconds
    std::int32_t slice_id = 0;             ///< the slice of the update
  };
  /// What became of a segment that no longer exists.
  struct End {
    std::uint32_t heir_id =
        kNoSegment;          ///< it was merged into this; kNoSegment: it lost all points
    std::int64_t utime = 0;  ///< as in Origin
    std::int32_t slice_id = 0;
  };
  struct Segment {
    SegmentStatistics statistics;
    std::int64_t sequence = 0;  ///< of the update with these statistics
    std::int64_t utime = 0;     ///< of that update; 0: of a full state, time of change unknown
  };

  /// Applies an update. Returns false if it is ignored, because it is of an older session.
  bool apply(const SegmentUpdate& update);

  /// The segments that exist, by ascending id.
  const std::map<std::uint32_t, Segment>& segments() const { return segments_; }
  /// nullptr: no segment with this id exists.
  const Segment* find(std::uint32_t segment_id) const;

  /// Where a segment came from, even if it no longer exists; nullptr: unknown.
  const Origin* origin(std::uint32_t segment_id) const;
  /// What became of a segment; nullptr: it exists, or that is unknown.
  const End* end(std::uint32_t segment_id) const;
  /// The existing segment that this one became by merging: itself, the segment that absorbed it, or
  /// the one that absorbed that, and so on. Nothing: there is none, or it is unknown.
  std::optional<std::uint32_t> heir(std::uint32_t segment_id) const;

  /// The newest update, without its vectors; nullptr: none was applied.
  const SegmentUpdate* newest() const { return newest_ ? &*newest_ : nullptr; }
  /// The map was complete after one of the applied updates.
  bool is_final() const { return is_final_; }
  /// Sequence number of the newest update that listed all segments; -1: there was none. Updates
  /// before it are not needed.
  std::int64_t listed_sequence() const { return listed_sequence_; }
  /// There are as many segments as the newest update says. If not, updates are missing, or several
  /// slices were segmented together and not all of their updates were applied yet.
  bool has_all_segments() const {
    return newest_ && static_cast<std::int64_t>(segments_.size()) == newest_->num_segments;
  }

 private:
  static std::tuple<std::int64_t, std::int64_t> age(const SegmentUpdate& update) {
    return {update.map_session, update.session};
  }
  void note_header(const SegmentUpdate& update);
  void apply_event(const SegmentUpdate& update, const SegmentEvent& event);
  void apply_statistics(const SegmentUpdate& update, const SegmentStatistics& statistics);
  void forget_unlisted(std::int64_t sequence);

  std::optional<SegmentUpdate> newest_;
  std::int64_t listed_sequence_ = -1;
  bool is_final_ = false;
  std::map<std::uint32_t, Segment> segments_;
  std::map<std::uint32_t, Origin> origins_;
  std::map<std::uint32_t, End> ends_;
};

}  // namespace kintsugi
