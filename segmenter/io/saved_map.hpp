#pragma once
// A segment map in one file, to be continued later.

#include <filesystem>
#include <memory>

#include "segmenter/map/segment_map.hpp"
#include "segmenter/map/segment_map_state.hpp"

namespace kintsugi::segmenter {

/// Writes beside `path` and renames, so that under `path` there is the old file or all of the new.
/// The same state gives the same bytes.
/// @throws std::runtime_error naming the file and the reason
void write_map_state(const SegmentMapState& state, const std::filesystem::path& path);

/// Reads what write_map_state() wrote. Counts are held against the size of the file, and all of it
/// against its checksum, before anything is made of it. Throws std::runtime_error naming the file,
/// the place, the reason and what was expected.
SegmentMapState read_map_state(const std::filesystem::path& path);

/// The map whose state this is. Throws std::runtime_error naming `path`, where it was read, and
/// what is wrong when it is no state of a map.
std::unique_ptr<SegmentMap> make_map(const SegmentMapState& state,
                                     const std::filesystem::path& path);

/// The map whose state is in the file. From then on its partition, thetas, ids, events and
/// statistics are those of the map that was saved.
/// @throws std::runtime_error as read_map_state() and make_map(); also when the points give other
///   segments than those in the file
std::unique_ptr<SegmentMap> load_map(const std::filesystem::path& path);

}  // namespace kintsugi::segmenter
