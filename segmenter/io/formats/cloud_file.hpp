#pragma once
// Reads a point cloud from a file of any format that is known.

#include <filesystem>
#include <string>
#include <string_view>

#include "segmenter/io/points/point_roles.hpp"
#include "segmenter/io/points/point_table.hpp"

namespace kintsugi::segmenter {

enum class CloudFormat { kPly, kPcd, kText, kLas, kNpy };

/// "PLY", "PCD", ...
std::string_view name_of(CloudFormat format);

/// The format of a file: by what it begins with, else by its extension, else text, if it is text.
/// @throws std::runtime_error naming the file, the formats that are read, and what it is if that is
///   a known one of others
CloudFormat format_of(std::string_view bytes, const std::filesystem::path& path);

/// Whether the name of a file is that of a cloud: *.ply, *.pcd, *.las, *.npy, *.xyz, ...
bool has_cloud_extension(const std::filesystem::path& path);

/// The points of a file with all their properties, and its other elements if it is a PLY file.
struct CloudFile {
  PointTable table;
  CloudFormat format = CloudFormat::kPly;
};

/// @param labels which columns are checked: find_roles()
/// @throws std::runtime_error as read_file_bytes(), format_of(), the reader of the format, and
///   find_roles()
CloudFile read_cloud_file(const std::filesystem::path& path, LabelUse labels);

}  // namespace kintsugi::segmenter
