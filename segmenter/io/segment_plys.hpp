#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "segmenter/map/map_snapshot.hpp"

namespace kintsugi::segmenter {

/// Writes the points of each of `segment_ids` as `folder`/segment_ID.ply, with the properties of
/// labelled_ply_writer.hpp, in the map's order. What else is in the folder stays.
/// @param segment_ids ascending, each once, and in the map
/// @throws std::system_error naming the file and the reason
void write_segment_plys(const MapSnapshot& map, std::span<const std::uint32_t> segment_ids,
                        const std::filesystem::path& folder);

}  // namespace kintsugi::segmenter
