// kintsugi-export: writes the segments of a map in the formats of other programs.

#include <algorithm>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <spdlog/sinks/stdout_color_sinks.h>

#include "lcmtypes/base/command_line.hpp"
#include "lcmtypes/base/logger.hpp"
#include "lcmtypes/base/run_main.hpp"
#include "segmenter/io/graph_file.hpp"
#include "segmenter/io/map_files.hpp"
#include "segmenter/io/scannet_segments.hpp"
#include "segmenter/io/segment_plys.hpp"
#include "segmenter/io/segments_csv.hpp"
#include "segmenter/tools/export/export_options.hpp"
#include "segmenter/tools/export/exported_map.hpp"
#include "segmenter/tools/export/html_scene.hpp"
#include "segmenter/tools/export/mesh_segments.hpp"

namespace kintsugi::segmenter {
namespace {

/// The ids of the wanted segments, ascending. Throws when one does not exist.
std::vector<std::uint32_t> chosen_segments(const ExportedMap& input, const ExportOptions& options) {
  const std::vector<SegmentStatistics>& segments = input.map.segments;
  std::vector<std::uint32_t> wanted = options.segment_ids;
  std::sort(wanted.begin(), wanted.end());
  std::vector<std::uint32_t> chosen;
  auto segment = segments.begin();
  const auto choose = [&] {
    if (segment->num_points >= options.min_points) chosen.push_back(segment->segment_id);
  };
  if (wanted.empty()) {
    for (; segment != segments.end(); ++segment) choose();
  }
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  for (const std::uint32_t id : wanted) {
    segment = std::find_if(segment, segments.end(),
                           [id](const SegmentStatistics& s) { return s.segment_id >= id; });
    if (segment == segments.end() || segment->segment_id != id) {
      throw std::runtime_error(options.input.string() + ": there is no segment " +
                               std::to_string(id) + " among its " +
                               std::to_string(segments.size()));
    }
    choose();
  }
  return chosen;
}

std::string scene_id_of(const ExportOptions& options) {
  if (!options.scene_id.empty()) return options.scene_id;
  std::filesystem::path name = options.segs.filename();
  while (name.extension() == ".json" || name.extension() == ".segs") name = name.stem();
  return name.string();
}

void write_segs(const ExportedMap& input, const ExportOptions& options) {
  if (options.mesh.empty() && options.ply.empty() && input.is_saved_map) {
    throw std::runtime_error(options.segs.string() +
                             ": needs the PLY file it is of: give --ply or --mesh");
  }
  const EngineConfig& engine = input.map.state.config.engine;
  std::optional<ScanNetParameters> parameters;
  if (input.is_saved_map) parameters = {engine.scale, engine.fragment_limit()};
  const std::vector<std::uint32_t> ids =
      options.mesh.empty() ? input.map.state.segment_ids : mesh_segments(input.map, options.mesh);
  write_scannet_segments(scene_id_of(options), parameters, ids, options.segs);
}

/// Writes the files that need a description of every segment.
void write_descriptions(const ExportedMap& input, const ExportOptions& options) {
  const LabelledCloud cloud = labelled_cloud(input.map);
  const AdjacencyGraph graph = adjacency_graph(cloud);
  const std::vector<SegmentDescription> segments =
      describe_segments(cloud, input.map.segments, input.map.state.last_changes, graph);
  if (!options.csv.empty()) write_segments_csv(segments, options.csv);
  if (!options.graph.empty()) write_graph(graph, segments, options.graph);
  if (!options.html.empty()) write_html_scene(input.map, segments, options.html);
  if (options.json.empty()) return;
  if (input.is_saved_map) {
    write_segments_json(input.map, segments, options.json);
  } else {
    write_segments_json(cloud, segments, options.json);
  }
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw std::runtime_error(folder.string() + ": cannot be made: " + error.message());
}

void run(const ExportOptions& options) {
  validate(options);
  const ExportedMap input = read_labelled_map(options.input, options.resolution_m);
  const std::vector<std::uint32_t> chosen = chosen_segments(input, options);
  spdlog::info("{}: {} points in {} segments, resolution {:.6g} m", options.input.string(),
               input.map.state.points_W.size(), input.map.segments.size(),
               input.map.state.config.engine.resolution_m);
  if (!options.segment_folder.empty()) make_folder(options.segment_folder);
  if (!options.segs.empty()) write_segs(input, options);
  if (!options.ply.empty()) write_map_ply(input.map, options.ply);
  if (!options.segment_folder.empty()) {
    write_segment_plys(input.map, chosen, options.segment_folder);
    spdlog::info("{}: {} segments", options.segment_folder.string(), chosen.size());
  }
  if (!options.json.empty() || !options.csv.empty() || !options.graph.empty() ||
      !options.html.empty()) {
    write_descriptions(input, options);
  }
}

}  // namespace
}  // namespace kintsugi::segmenter

int main(int argc, char** argv) {
  using namespace kintsugi::segmenter;
  return kintsugi::run_main(argv, [&] {
    spdlog::set_default_logger(spdlog::stderr_color_mt("kintsugi-export"));
    spdlog::set_pattern("%^%l%$: %v");
    CLI::App app{"Writes the segments of a map in the formats of other programs."};
    ExportOptions options;
    add_options(app, options);
    kintsugi::add_version_flag(app);
    CLI11_PARSE(app, argc, argv);
    run(options);
    return 0;
  });
}
