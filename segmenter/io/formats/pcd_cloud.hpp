#pragma once
// Reads points from PCD files (Point Cloud Library).

#include <string>
#include <string_view>

#include "segmenter/io/points/point_table.hpp"

namespace kintsugi::segmenter {

/// Reads PCD with DATA ascii, binary or binary_compressed (LZF): every field as parse_pcd_header()
/// names its columns. The VIEWPOINT is kept as a comment.
///
/// @param bytes of the file; `name` stands for it in errors
/// @throws std::runtime_error naming the file, the place (line, byte) and what was expected: a bad
///   header, more points than the data have, compressed data that are damaged, words that are not
///   numbers
PointTable parse_pcd_cloud(std::string_view bytes, const std::string& name);

}  // namespace kintsugi::segmenter
