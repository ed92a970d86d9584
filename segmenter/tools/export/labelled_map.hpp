#pragma once
// A segmented map from a file.

#include <filesystem>

#include "segmenter/map/map_snapshot.hpp"

namespace kintsugi::segmenter {

struct LabelledMap {
  MapSnapshot map;  ///< points in the order of the file
  /// It is a saved map. Else a labelled PLY file: of parameters and slices the resolution and what
  /// slice_id tells is known, and nothing of last changes and completeness.
  bool is_saved_map = false;
};

/// Reads a saved map (kintsugi-segmenter --save), or a labelled PLY file: one with segment_id, and
/// with slice_id or without. Which of the two it is the file says. Normals that are missing, or
/// cannot be used, are zero.
/// @param resolution_m voxel size of a PLY file; 0: the median spacing of its points
/// @throws std::runtime_error naming the file and the reason: neither of the two; no segment_id;
///   points that may not be in a map; a resolution for a saved map, which has its own, or one that
///   cannot be estimated
LabelledMap read_labelled_map(const std::filesystem::path& path, double resolution_m);

}  // namespace kintsugi::segmenter
