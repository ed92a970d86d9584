#pragma once

#include <filesystem>
#include <span>

#include "segmenter/description/segment_description.hpp"

namespace kintsugi::segmenter {

/// Writes a table with a line a segment, the names of the columns first; metres, frame W. The
/// columns are those of segments.json, vectors one number a column, the oriented box by its centre,
/// its sizes and the unit quaternion of its axes; neighbours as ids separated by blanks.
/// @throws std::system_error naming the file and the reason
void write_segments_csv(std::span<const SegmentDescription> segments,
                        const std::filesystem::path& path);

}  // namespace kintsugi::segmenter
