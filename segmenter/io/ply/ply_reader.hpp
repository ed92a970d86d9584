#pragma once
// Reads clouds from PLY files of this and other programs.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

/// The vertices of a PLY file, in its order; every per-point vector is as long as points_W, or
/// empty where the file has no such property.
struct PlyCloud {
  std::vector<CloudPoint> points_W;         ///< properties the file lacks are zero
  std::vector<std::int32_t> slice_ids;      ///< order of arrival, >= 0
  std::vector<std::uint32_t> segment_ids;   ///< of a labelled cloud
  std::vector<std::uint8_t> in_volume;      ///< of a labelled cloud: 1: of a patch that may change
  std::vector<std::uint32_t> instance_ids;  ///< true instances, of a cloud for evaluation
  bool has_normals = false;
  std::vector<std::string> comments;  ///< of the header, in its order
};

/// Reads ascii and binary PLY of either byte order.
///
/// Of element `vertex` it uses x y z (float or double; required), nx ny nz (float or double),
/// red green blue (uchar, or float in 0..1), weight (any type), slice_id, segment_id, instance_id
/// and in_volume (any integer type; in_volume: 0 or 1). Other properties and elements are skipped,
/// but must be complete. Positions become float32. Values that are not finite, or too large, are
/// kept; whether a point can be segmented is decided later (admission.hpp).
///
/// @throws std::runtime_error naming the file, the place (line, byte offset, vertex) and what was
///   expected: a file that cannot be read, a bad header, a count that the file cannot hold, missing
///   or partial properties, properties of another type, values that are not numbers, a colour or a
///   slice_id out of range, data that end early or do not end where the header says
PlyCloud read_ply(const std::filesystem::path& path);

/// The same for a file that is already in memory; `name` stands for it in errors.
PlyCloud parse_ply(std::string_view bytes, const std::string& name);

}  // namespace kintsugi::segmenter
