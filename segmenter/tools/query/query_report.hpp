#pragma once
// Answers as a table for people and as JSON for programs.

#include <cstdint>
#include <string>

#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

/// Why an answer about a pixel has no segment.
enum class PixelResult : std::uint8_t {
  kFound,
  kNoView,        ///< the segmenter knows no view of the camera
  kNotMeasured,   ///< the camera measures nothing at the pixel
  kNotSegmented,  ///< the surface at the pixel is in no segment yet
};
PixelResult pixel_result(const SegmentAnswer& answer);

/// A line for each segment, under a header; for a single segment also all details. Lengths in
/// metres, frame W.
/// @param place of the query
std::string answer_table(const SegmentAnswer& answer, QueryPlace place);

/// One JSON object: `map` (name, sessions, slices, points, segments), `matching` (how many segments
/// do, even when fewer were wanted), `hit` (the map point that was found; null: none) and
/// `segments`, each with the keys of segments.json and its `distance`. Metres, frame W. About a
/// pixel also `view_utime` (device time of the view, microseconds; null: no view) and
/// `surface_distance_m` (from the camera; null: not measured).
/// @param place of the query
std::string answer_json(const SegmentAnswer& answer, QueryPlace place);

}  // namespace kintsugi::segmenter
