#pragma once
// Segment updates and tables as text for a person, and as JSON for programs.

#include <cstddef>
#include <iosfwd>
#include <string>

#include "lcmtypes/client/segment_table.hpp"

namespace kintsugi {

/// An update as lines of text: a summary, and a line for each segment that was created, split off,
/// merged or retired, and if `with_grown` for each that grew. Empty if no segment changed.
std::string update_text(const SegmentUpdate& update, bool with_grown);

/// The table as lines of text: a summary, and the `num_listed` segments with the most points.
std::string table_text(const SegmentTable& table, std::size_t num_listed);

/// Writes the table as JSON. A segment has the fields of its statistics, and `born`: slice and
/// parent (0: none), or null if that is unknown.
/// @param is_whole no update is missing
void write_table_json(const SegmentTable& table, bool is_whole, std::ostream& out);

}  // namespace kintsugi
