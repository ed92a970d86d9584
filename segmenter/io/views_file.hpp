#pragma once
// What the camera saw, in a file beside the saved map, and as bytes in answers on the bus.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "segmenter/views/kept_view.hpp"

namespace kintsugi::segmenter {

/// The file that belongs to a saved map: MAP.views.
std::filesystem::path views_file_of(const std::filesystem::path& saved_map);

/// Writes beside `path` and renames, so that under `path` there is the old file or all of the new.
/// The same views give the same bytes: 256 for each view, and its compressed depth.
/// @throws std::runtime_error naming the file and the reason
void write_views(const ViewSet& views, const std::filesystem::path& path);

/// Reads what write_views() wrote. Counts are held against the size of the file, and all of it
/// against its checksum, before anything is made of it; every depth image can be unpacked.
/// @throws std::runtime_error naming the file, the place, the reason and what was expected
ViewSet read_views(const std::filesystem::path& path);

/// What write_views() would write.
std::vector<std::uint8_t> view_bytes(const ViewSet& views);

/// Reads what view_bytes() made, as read_views() does. @param source what errors call it
/// @throws std::runtime_error naming the source, the place, the reason and what was expected
ViewSet views_of_bytes(std::span<const std::uint8_t> bytes, const std::string& source);

/// The same of the map of this session.
/// @throws std::runtime_error also when the views are of another map
ViewSet read_views_of(const std::filesystem::path& path, std::int64_t map_session,
                      const std::string& map_name);

}  // namespace kintsugi::segmenter
