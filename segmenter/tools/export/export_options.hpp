#pragma once
// The command line of kintsugi-export.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace kintsugi::segmenter {

struct ExportOptions {
  std::filesystem::path input;
  double resolution_m = 0.0;   ///< 0: the map's own, or the spacing of its points
  std::filesystem::path json;  ///< each of these: empty: not written
  std::filesystem::path csv;
  std::filesystem::path ply;
  std::filesystem::path graph;
  std::filesystem::path segs;
  std::filesystem::path html;
  std::string scene_id;                    ///< of `segs`; empty: its file name without .segs.json
  std::filesystem::path mesh;              ///< whose vertices `segs` is of
  std::filesystem::path segment_folder;    ///< for one PLY file a segment
  std::vector<std::uint32_t> segment_ids;  ///< which of them; empty: all
  std::uint32_t min_points = 0;            ///< of those
};

void add_options(CLI::App& app, ExportOptions& options);

/// @throws std::runtime_error when there is nothing to write, a folder does not exist, or two files
///   are one
void validate(const ExportOptions& options);

}  // namespace kintsugi::segmenter
