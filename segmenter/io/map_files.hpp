#pragma once
// The files that a segment map leaves behind.

#include <filesystem>
#include <string>

#include "segmenter/map/map_snapshot.hpp"

namespace kintsugi::segmenter {

/// Writes the labelled map (labelled_ply_writer.hpp), slice after slice in the order they were
/// added. Points rejected at the door are left out: their slice and number are in segments.json.
void write_map_ply(const MapSnapshot& map, const std::filesystem::path& path);

/// Writes mode, parameters, sessions and counts, the slices that were corrected, the points that
/// were rejected, then for each segment by ascending id: points, bounding box, centroid, mean
/// normal, mean colour, area, first and last slice. Metres, frame W.
void write_segments_json(const MapSnapshot& map, const std::filesystem::path& path);

/// Writes both as `folder`/`stem`.ply and .json, and makes the folder when it is not there. Each
/// file is whole or absent.
/// @throws std::runtime_error (std::system_error) naming the file and the reason
void write_map_files(const MapSnapshot& map, const std::filesystem::path& folder,
                     const std::string& stem);

}  // namespace kintsugi::segmenter
