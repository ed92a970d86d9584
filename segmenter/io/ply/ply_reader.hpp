#pragma once
// Reads clouds from PLY files of this and other programs.

#include <filesystem>
#include <string>
#include <string_view>

#include "segmenter/io/points/file_cloud.hpp"

namespace kintsugi::segmenter {

/// The vertices of a PLY file.
using PlyCloud = FileCloud;

/// Reads ascii and binary PLY of either byte order. Of element `vertex` it uses the properties that
/// find_roles() names. Other properties and elements are skipped, but must be complete. Coordinates
/// are metres unless a comment tells their unit (unit_told_by()).
///
/// @throws std::runtime_error naming the file, the place (line, byte offset, vertex) and what was
///   expected, as read_file_bytes(), parse_ply_table(), find_roles() and cloud_of()
PlyCloud read_ply(const std::filesystem::path& path);

/// The same for a file that is already in memory; `name` stands for it in errors.
PlyCloud parse_ply(std::string_view bytes, const std::string& name);

}  // namespace kintsugi::segmenter
