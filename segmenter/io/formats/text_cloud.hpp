#pragma once
// Reads points from text: XYZ, PTS, TXT, ASC, CSV.

#include <string>
#include <string_view>

#include "segmenter/io/points/point_table.hpp"

namespace kintsugi::segmenter {

/// Reads a line of numbers for each point, between blanks, tabs, commas or semicolons, with quotes
/// around them or without; an empty place between commas is NaN. Lines that begin with # or // are
/// comments, and so is what follows either behind a blank. Columns have the names
/// of a line of words before the first point, which may be the last comment; without one they are
/// guessed (guess_column_names()). Columns are double; colours are integers where they are whole.
/// A line with one number tells how many points follow, as in PTS files, where scans are one behind
/// the other.
///
/// @param bytes of the file; `name` stands for it in errors
/// @throws std::runtime_error naming the file, the line and what was expected: fewer than three
///   columns, a row with more or fewer values than the first, a word that is not a number, names
///   without x y z, another number of points than a line tells
PointTable parse_text_cloud(std::string_view bytes, const std::string& name);

}  // namespace kintsugi::segmenter
