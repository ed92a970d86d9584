#include "segmenter/tools/export/export_options.hpp"

#include <algorithm>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include "lcmtypes/base/number_range.hpp"
#include "lcmtypes/base/output_files.hpp"

namespace kintsugi::segmenter {
void add_options(CLI::App& app, ExportOptions& options) {
  app.add_option("MAP", options.input,
                 "a saved map (kintsugi-segmenter --save), or a labelled PLY file")
      ->required();
  app.add_option("--json", options.json, "write the description of every segment as JSON");
  app.add_option("--csv", options.csv, "write the same as a table, one line for each segment");
  app.add_option("--graph", options.graph, "write the graph of touching segments as GraphML");
  app.add_option("--html", options.html,
                 "write a page that shows the map in a browser, as one file that loads nothing");
  app.add_option("--ply", options.ply, "write all points with their segment_id");
  auto* const segs = app.add_option(
      "--segs", options.segs,
      "write ScanNet's segs.json: the segment of each vertex of --mesh, otherwise of "
      "--ply, otherwise of MAP if that is a PLY file");
  app.add_option("--scene-id", options.scene_id,
                 "sceneId in it (default: its name without .segs.json)")
      ->needs(segs);
  app.add_option(
      "--mesh", options.mesh,
      "a PLY file whose vertices get the segment of the nearest point within two voxels");
  auto* const folder =
      app.add_option("--segment-plys", options.segment_folder,
                     "write each segment as segment_ID.ply in this folder, made when absent");
  app.add_option("--segments", options.segment_ids,
                 "ID,ID,...: of --segment-plys only these segments (default: all)")
      ->delimiter(',')
      ->needs(folder);
  app.add_option("--min-points", options.min_points,
                 "of --segment-plys only segments with at least this many points")
      ->needs(folder);
  app.add_option("--resolution", options.resolution_m,
                 "voxel size of a PLY file in metres (default: the median spacing of the points)")
      ->check(number_range(1e-6, 1e3));
}

void validate(const ExportOptions& options) {
  const auto files = {options.json, options.csv, options.graph,
                      options.html, options.ply, options.segs};
  if (options.segment_folder.empty() &&
      std::all_of(files.begin(), files.end(), [](const auto& file) { return file.empty(); })) {
    throw std::runtime_error(
        "nothing to write: give --json, --csv, --graph, --html, --ply, --segs or --segment-plys");
  }
  if (!options.mesh.empty() && options.segs.empty()) {
    throw std::runtime_error("--mesh is of no use without --segs");
  }
  check_different({{"MAP", options.input}, {"--mesh", options.mesh}}, {{"--json", options.json},
                                                                       {"--csv", options.csv},
                                                                       {"--graph", options.graph},
                                                                       {"--html", options.html},
                                                                       {"--ply", options.ply},
                                                                       {"--segs", options.segs}});
  for (const auto& file : files) check_folder_of(file);
}

}  // namespace kintsugi::segmenter
