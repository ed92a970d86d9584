#pragma once
// A map as one HTML file that a browser shows in 3-D.

#include <filesystem>
#include <span>
#include <vector>

#include "lcmtypes/scene/tile.hpp"
#include "segmenter/description/segment_description.hpp"
#include "segmenter/map/map_snapshot.hpp"

namespace kintsugi::segmenter {

/// The page of kintsugi-viewer --http with the map in it: it loads nothing and can be sent to
/// somebody. About 20 bytes for each point.
/// @param segments all segments of the map, by ascending id
/// @throws std::system_error when the file cannot be written; then there is none
void write_html_scene(const MapSnapshot& map, std::span<const SegmentDescription> segments,
                      const std::filesystem::path& file);

/// The points of the map in cubes of 64 voxels, each part of the map for itself; without those
/// whose position could not be segmented, which a labelled PLY file keeps.
std::vector<scene::Tile> tiles_of(const MapSnapshot& map);

}  // namespace kintsugi::segmenter
