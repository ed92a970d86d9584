#pragma once

#include <filesystem>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter::bench {

/// The points of a map in the order of arrival, slice after slice, frame W.
using Slices = std::vector<std::vector<CloudPoint>>;

/// Reads a PLY file with normals, by ascending slice_id (one slice without it), or a *.bin file:
/// u64 number of slices n, u64 first point of each and the number of points (n + 1 in all), then
/// for each point float32 x y z nx ny nz, little-endian. Throws std::runtime_error naming the file
/// and what was expected.
Slices read_map(const std::filesystem::path& file);

std::vector<CloudPoint> all_points(const Slices& slices);

}  // namespace kintsugi::segmenter::bench
