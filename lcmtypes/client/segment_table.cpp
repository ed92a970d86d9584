#include "lcmtypes/client/segment_table.hpp"

#include <utility>

namespace kintsugi {
namespace {

SegmentUpdate header_of(const SegmentUpdate& update) {
  SegmentUpdate header;
  header.utime = update.utime;
  header.session = update.session;
  header.sequence = update.sequence;
  header.map_session = update.map_session;
  header.map_name = update.map_name;
  header.slice_id = update.slice_id;
  header.slice_revision = update.slice_revision;
  header.is_final = update.is_final;
  header.num_slices = update.num_slices;
  header.num_points = update.num_points;
  header.num_segments = update.num_segments;
  return header;
}

template <class Value>
const Value* look_up(const std::map<std::uint32_t, Value>& values, std::uint32_t id) {
  const auto found = values.find(id);
  return found != values.end() ? &found->second : nullptr;
}

}  // namespace

bool SegmentTable::apply(const SegmentUpdate& update) {
  if (newest_ && age(update) < age(*newest_)) return false;
  if (newest_ && age(update) > age(*newest_)) *this = SegmentTable();
  note_header(update);
  for (const SegmentEvent& event : update.events) apply_event(update, event);
  for (const SegmentStatistics& statistics : update.statistics) {
    apply_statistics(update, statistics);
  }
  if (lists_all_segments(update)) forget_unlisted(update.sequence);
  return true;
}

void SegmentTable::note_header(const SegmentUpdate& update) {
  if (!newest_ || update.sequence > newest_->sequence) newest_ = header_of(update);
  is_final_ = is_final_ || update.is_final;
}

void SegmentTable::apply_event(const SegmentUpdate& update, const SegmentEvent& event) {
  const auto end = [&](std::uint32_t id, std::uint32_t heir_id) {
    ends_[id] = {heir_id, update.utime, update.slice_id};
    segments_.erase(id);
  };
  switch (event.type) {
    case SegmentEventType::kCreated:
      origins_[event.segment_id] = {kNoSegment, update.utime, update.slice_id};
      break;
    case SegmentEventType::kSplit:
      origins_[event.other_id] = {event.segment_id, update.utime, update.slice_id};
      break;
    case SegmentEventType::kMerged:
      end(event.other_id, event.segment_id);
      break;
    case SegmentEventType::kRetired:
      end(event.segment_id, kNoSegment);
      break;
    case SegmentEventType::kGrown:  // changes only statistics
      break;
  }
}

void SegmentTable::apply_statistics(const SegmentUpdate& update,
                                    const SegmentStatistics& statistics) {
  const std::uint32_t id = statistics.segment_id;
  if (ends_.contains(id) || update.sequence < listed_sequence_) return;
  Segment segment{statistics, update.sequence, update.utime};
  const auto [place, is_new] = segments_.try_emplace(id, segment);
  if (!is_new && place->second.sequence < update.sequence) place->second = segment;
}

/// Removes the segments that were not updated since `sequence`, an update that lists all segments.
void SegmentTable::forget_unlisted(std::int64_t sequence) {
  if (sequence <= listed_sequence_) return;
  listed_sequence_ = sequence;
  std::erase_if(segments_, [&](const auto& entry) { return entry.second.sequence < sequence; });
}

const SegmentTable::Segment* SegmentTable::find(std::uint32_t segment_id) const {
  return look_up(segments_, segment_id);
}

const SegmentTable::Origin* SegmentTable::origin(std::uint32_t segment_id) const {
  return look_up(origins_, segment_id);
}

const SegmentTable::End* SegmentTable::end(std::uint32_t segment_id) const {
  return look_up(ends_, segment_id);
}

std::optional<std::uint32_t> SegmentTable::heir(std::uint32_t segment_id) const {
  // The limit ends a circle, which only an invalid stream can have.
  for (std::size_t step = 0; step <= ends_.size(); ++step) {
    if (segments_.contains(segment_id)) return segment_id;
    const auto gone = ends_.find(segment_id);
    if (gone == ends_.end()) return std::nullopt;
    segment_id = gone->second.heir_id;
  }
  return std::nullopt;
}

}  // namespace kintsugi
