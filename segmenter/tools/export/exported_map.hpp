#pragma once
// A segmented map from a file.

#include <filesystem>

#include "segmenter/map/map_snapshot.hpp"

namespace kintsugi::segmenter {

struct ExportedMap {
  MapSnapshot map;  ///< points in the order of the file
  /// False for a labelled PLY file: then only the resolution and the slice ids of the points are
  /// known, but no other parameters, last changes or completeness.
  bool is_saved_map = false;
};

/// Reads a saved map (kintsugi-segmenter --save), or a labelled PLY file with segment_id and
/// optionally slice_id; the first bytes of the file tell which. Missing and unusable normals become
/// zero.
/// @param resolution_m voxel size of a PLY file; 0: the median spacing of its points
/// @throws std::runtime_error naming the file and the reason: neither of the two; no segment_id;
///   points that may not be in a map; a resolution that is given for a saved map, which has its
///   own, or that cannot be estimated
ExportedMap read_labelled_map(const std::filesystem::path& path, double resolution_m);

}  // namespace kintsugi::segmenter
