#include "segmenter/tools/cloud_options.hpp"

#include <CLI/CLI.hpp>

#include "lcmtypes/base/number_range.hpp"

namespace kintsugi::segmenter {

void add_cloud_options(CLI::App& app, CloudInputConfig& config) {
  app.add_option("--resolution", config.resolution_m,
                 "voxel size in metres (default: the median spacing of the points)")
      ->check(number_range(1e-6, 1e3));
  app.add_option("--normals-k", config.normals.num_neighbours,
                 "number of neighbours to compute missing normals from, >= 3")
      ->capture_default_str();
  app.add_flag(
      "--average-normals", config.averages_given_normals,
      "also average the normals that the file gives within two voxels, as computed ones are");
  app.add_option(
         "--viewpoint", config.viewpoint_W,
         "X Y Z: computed normals point towards here, metres (default: the mean of the points)")
      ->expected(3);
  app.add_option(
         "--unit", config.unit,
         "unit of the coordinates: m, cm or mm (default: the one that the header tells by a line "
         "'comment unit mm', else m, with a warning where that seems wrong)")
      ->check(CLI::IsMember({"m", "cm", "mm"}));
}

}  // namespace kintsugi::segmenter
