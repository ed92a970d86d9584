// kintsugi-ground-truth: the true instance of every point of a map of a synthetic scene; or what
// changed between two scenes.

#include <algorithm>
#include <iostream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "lcmtypes/base/atomic_file.hpp"
#include "lcmtypes/base/command_line.hpp"
#include "lcmtypes/base/run_main.hpp"
#include "mapper/evaluation/instance_labels.hpp"
#include "mapper/evaluation/scene_pairs.hpp"
#include "mapper/tools/map_of_scene.hpp"

namespace {

using namespace kintsugi;
using namespace kintsugi::mapper;

struct Options {
  MapOfSceneOptions map;
  std::string out;
  double max_distance_m = 0.03;
  std::int64_t min_points = 100;
  bool changes = false;
  bool objects = false;
};

struct Found {
  int objects = 0;
  int structure = 0;
};

/// Instances with at least `min_points` points.
Found count_instances(const std::vector<std::uint32_t>& labels, const synthetic::Scene& scene,
                      std::int64_t min_points) {
  std::vector<std::int64_t> num_points(scene.instances().size() + 1, 0);
  for (const std::uint32_t label : labels) ++num_points.at(label);
  Found found;
  for (const synthetic::Instance& instance : scene.instances()) {
    if (num_points.at(static_cast<std::size_t>(instance.id)) < min_points) continue;
    ++(instance.is_structure ? found.structure : found.objects);
  }
  return found;
}

void label(const Options& options) {
  const MapOfScene map = read_map_of_scene(options.map);
  const auto labels = nearest_instances(map.points_W, map.scene, map.X_SW, options.max_distance_m);
  write_instance_cloud(options.out, map.points_W, labels, map.scene);
  const Found found = count_instances(labels, map.scene, options.min_points);
  std::cout << "points " << labels.size() << "  unlabelled "
            << std::count(labels.begin(), labels.end(), 0U) << "  min_points " << options.min_points
            << "  objects " << found.objects << "  structure " << found.structure << '\n';
}

/// The file of --changes and --objects; CLOUD is the second scene.
void compare_scenes(const Options& options) {
  const SceneOfMap before = read_scene(options.map.scene, options.map.in_scene_frame);
  const SceneOfMap after = read_scene(options.map.cloud, options.map.in_scene_frame);
  AtomicFile file(options.out);
  file.stream() << scene_pairs_json({options.map.scene, before.scene, before.X_SW},
                                    {options.map.cloud, after.scene, after.X_SW}, options.changes);
  file.commit();
}

void add_options(CLI::App& app, Options& options) {
  add_scene(app, options.map);
  add_cloud(app, options.map);
  app.add_option("OUT", options.out, "PLY file to write: x y z (of CLOUD) and instance_id")
      ->required();
  add_scene_frame(app, options.map);
  app.add_option("--max-distance", options.max_distance_m,
                 "points farther than this from every surface get instance 0, m")
      ->capture_default_str();
  app.add_option("--min-points", options.min_points,
                 "the printed counts include instances with at least this many points")
      ->capture_default_str();
  auto* const changes = app.add_flag(
      "--changes", options.changes,
      "CLOUD is the same room later, synthetic://NAME?...: OUT is a JSON file of what is new, gone "
      "and moved, with poses and symmetry, for kintsugi-evaluate");
  app.add_flag(
         "--objects", options.objects,
         "CLOUD is another room, synthetic://NAME?...: OUT is a JSON file of the objects that "
         "are in both")
      ->excludes(changes);
}

}  // namespace

int main(int argc, char** argv) {
  return kintsugi::run_main(argv, [&] {
    Options options;
    CLI::App app{
        "Labels every point of a map with the instance of the nearest surface of the synthetic "
        "scene that was mapped."};
    add_options(app, options);
    kintsugi::add_version_flag(app);
    CLI11_PARSE(app, argc, argv);
    options.changes || options.objects ? compare_scenes(options) : label(options);
    return 0;
  });
}
