#pragma once
// The map files: segments.ply, segments.json and segments.csv.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "segmenter/description/segment_description.hpp"
#include "segmenter/map/map_snapshot.hpp"

namespace kintsugi::segmenter {

/// Writes the labelled map (labelled_ply_writer.hpp), slice after slice in the order they were
/// added. Rejected points are left out; segments.json has their slice and number.
void write_map_ply(const MapSnapshot& map, const std::filesystem::path& path);

/// Writes mode, parameters, sessions, counts, corrected slices and rejected points, then a line
/// with the description of each segment, by ascending id. Metres, frame W. segmenter/README.md
/// lists the keys.
/// @param segments describe_segments() of the map
/// @param origin_W of a cloud that was moved before it was segmented: is added to every place, and
///   written as `origin` unless it is zero
void write_segments_json(const MapSnapshot& map, std::span<const SegmentDescription> segments,
                         const std::filesystem::path& path,
                         const Eigen::Vector3d& origin_W = Eigen::Vector3d::Zero());
/// The same; computes the descriptions itself.
void write_segments_json(const MapSnapshot& map, const std::filesystem::path& path,
                         const Eigen::Vector3d& origin_W = Eigen::Vector3d::Zero());
/// The same for a labelled cloud that is not a saved map: without mode, sessions and slices.
void write_segments_json(const LabelledCloud& cloud, std::span<const SegmentDescription> segments,
                         const std::filesystem::path& path);

/// Writes `folder`/`stem`.ply, .json and .csv (segments_csv.hpp) of part 0, and the same of each
/// other part that has points under its part_stem(); makes the folder if needed. Each file appears
/// complete or not at all.
/// @throws std::system_error naming the file and the reason
void write_map_files(const MapSnapshot& map, const std::filesystem::path& folder,
                     const std::string& stem);

/// Removes what write_map_files() has written of a part, as far as it is there.
/// @throws std::filesystem::filesystem_error naming the file and the reason
void remove_map_files(const std::filesystem::path& folder, const std::string& stem,
                      std::int32_t part);

/// The stem of the files of a part: `stem` itself for part 0, then "segments.part1" and so on.
std::string part_stem(const std::string& stem, std::int32_t part);

}  // namespace kintsugi::segmenter
