#pragma once
// What happened to segments, and which there are, for a person and for programs.

#include <cstddef>
#include <iosfwd>
#include <string>

#include "lcmtypes/client/segment_table.hpp"

namespace kintsugi {

/// The update as lines: a summary, and one for each segment that appeared, was split off, merged or
/// retired; with `with_grown` also for each that grew. Empty when it tells of no segment.
std::string update_text(const SegmentUpdate& update, bool with_grown);

/// The table as lines: a summary, and the `num_listed` segments of most points.
std::string table_text(const SegmentTable& table, std::size_t num_listed);

/// The table as JSON; `is_whole`: no update is missing. The keys of a segment are those of
/// segments.json, and `born`: slice and parent (0: none), null when not heard.
void write_table_json(const SegmentTable& table, bool is_whole, std::ostream& out);

}  // namespace kintsugi
