#pragma once
// Writes a cloud as it came, with labels.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "segmenter/io/cloud_input.hpp"

namespace kintsugi::segmenter {

/// Writes a binary PLY file with every property of the input in its order and type, the other
/// elements of a PLY file (faces), and behind them
///   float nx ny nz, unless the input has them: the normals that were segmented
///   int segment_id, instead of a segment_id of the input
/// Normals of the input that were computed, scaled or averaged are replaced. Lists of vertices are
/// left out, with a warning. The complete file appears under its name at the end.
///
/// @param comments for the header, behind those of the input
/// @param labels one for each point of the input
/// @throws std::system_error naming the file and the reason
void write_labelled_cloud(const CloudInput& input, std::span<const std::uint32_t> labels,
                          const std::vector<std::string>& comments,
                          const std::filesystem::path& path);

}  // namespace kintsugi::segmenter
