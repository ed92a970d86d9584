#pragma once
// Transfers the segments of a map to the vertices of a mesh.

#include <cstdint>
#include <filesystem>
#include <vector>

#include "segmenter/map/map_snapshot.hpp"

namespace kintsugi::segmenter {

/// The segment of each vertex of a mesh, in its order: that of the nearest point of the map which
/// is in a segment; kNoSegment where none is closer than r.
/// @param mesh a PLY file in the map's frame, W; its faces are not looked at
/// @throws std::runtime_error as read_ply(); when a vertex has a position that cannot be used
std::vector<std::uint32_t> mesh_segments(const MapSnapshot& map, const std::filesystem::path& mesh);

}  // namespace kintsugi::segmenter
