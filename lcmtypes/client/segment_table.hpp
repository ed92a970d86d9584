#pragma once
// The segments of a map as a client knows them, from SEGMENT_UPDATE alone.

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>

#include "lcmtypes/messages.hpp"

namespace kintsugi {

/// True when the update lists every segment that there is after it: the last one of a full state
/// does, and any other that changed them all.
inline bool lists_all_segments(const SegmentUpdate& update) {
  return static_cast<std::int64_t>(update.statistics.size()) == update.num_segments;
}

/// The table of the segments of one map: which there are, what is known of each, where it came
/// from, and what became of those that are gone.
///
/// Updates may come in any order and more than once: the table after a set of updates is the same.
/// That rests on what a segmenter promises: ids are never used again in its session, the birth and
/// the death of each is told by one event, and the statistics in an update are those of every
/// segment that changed, which only a later update replaces.
///
/// A table that missed updates is right again after the next one that lists all segments, a full
/// state for instance, as a listener gets that comes late: what such an update does not list is
/// gone, and nobody says how.
///
/// Which map it is is the caller's choice; of its sessions the table has the newest. An update of a
/// newer session of the mapper, or of a newer segmenter, begins it anew; one of an older is
/// ignored.
class SegmentTable {
 public:
  /// Where a segment came from.
  struct Origin {
    std::uint32_t parent_id = kNoSegment;  ///< split off it; kNoSegment: of new points
    std::int64_t utime = 0;                ///< device time of the slice, microseconds
    std::int32_t slice_id = 0;             ///< the slice that brought it about
  };
  /// What became of a segment that is gone.
  struct End {
    std::uint32_t heir_id = kNoSegment;  ///< absorbed by it; kNoSegment: it lost all its points
    std::int64_t utime = 0;              ///< as in Origin
    std::int32_t slice_id = 0;
  };
  struct Segment {
    SegmentStatistics statistics;
    std::int64_t sequence = 0;  ///< of the update that told them
    std::int64_t utime = 0;     ///< of that update; 0: told by a full state, changed at any time
  };

  /// Takes over what the update says. False when it is of an older session: ignored.
  bool apply(const SegmentUpdate& update);

  /// Those that there are, by ascending id.
  const std::map<std::uint32_t, Segment>& segments() const { return segments_; }
  /// nullptr: there is no such segment.
  const Segment* find(std::uint32_t segment_id) const;

  /// The birth of a segment, also of one that is gone; nullptr: it was not heard.
  const Origin* origin(std::uint32_t segment_id) const;
  /// The death of a segment; nullptr: it was not heard.
  const End* end(std::uint32_t segment_id) const;
  /// The segment that there is and has taken the place of this one: itself, or who absorbed it, or
  /// who absorbed that one, and so on. Nothing when there is none, or it is not known.
  std::optional<std::uint32_t> heir(std::uint32_t segment_id) const;

  /// The newest update, without its vectors; nullptr: there was none.
  const SegmentUpdate* newest() const { return newest_ ? &*newest_ : nullptr; }
  /// The map was complete after one of the updates.
  bool is_final() const { return is_final_; }
  /// Sequence number of the newest update that listed all segments; -1: there was none. What is
  /// missing of the updates before it is not missed.
  std::int64_t listed_sequence() const { return listed_sequence_; }
  /// There are as many segments as the newest update says. Where not, updates are missing, or are
  /// the others of several slices that were segmented in one.
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
