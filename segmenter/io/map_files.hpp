#pragma once
// The files that a segment map leaves behind.

#include <filesystem>
#include <span>
#include <string>

#include "segmenter/description/segment_description.hpp"
#include "segmenter/map/map_snapshot.hpp"

namespace kintsugi::segmenter {

/// Writes the labelled map (labelled_ply_writer.hpp), slice after slice in the order they were
/// added. Points rejected at the door are left out: their slice and number are in segments.json.
void write_map_ply(const MapSnapshot& map, const std::filesystem::path& path);

/// Writes mode, parameters, sessions and counts, the slices that were corrected, the points that
/// were rejected, then a line for each segment by ascending id: its description. Metres, frame W.
/// README lists the keys.
/// @param segments describe_segments() of the map
void write_segments_json(const MapSnapshot& map, std::span<const SegmentDescription> segments,
                         const std::filesystem::path& path);
/// Describes them, too.
void write_segments_json(const MapSnapshot& map, const std::filesystem::path& path);
/// Of a cloud of which nothing else is known: without mode, sessions and slices.
void write_segments_json(const LabelledCloud& cloud, std::span<const SegmentDescription> segments,
                         const std::filesystem::path& path);

/// Writes `folder`/`stem`.ply, .json and .csv (segments_csv.hpp), and makes the folder when it is
/// not there. Each file is whole or absent.
/// @throws std::runtime_error (std::system_error) naming the file and the reason
void write_map_files(const MapSnapshot& map, const std::filesystem::path& folder,
                     const std::string& stem);

}  // namespace kintsugi::segmenter
