#pragma once
// Answers as a table for people and as JSON for programs.

#include <string>

#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

/// A line for each segment, under a header; for a single segment also all details. Lengths in
/// metres, frame W.
std::string answer_table(const SegmentAnswer& answer);

/// One JSON object: `map` (name, sessions, slices, points, segments), `matching` (how many segments
/// do, even when fewer were wanted), `hit` (the map point that was found; null: none) and
/// `segments`, each with the keys of segments.json and its `distance`. Metres, frame W.
std::string answer_json(const SegmentAnswer& answer);

}  // namespace kintsugi::segmenter
