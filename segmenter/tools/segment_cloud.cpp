// kintsugi-segment-cloud: segments a point cloud from a file.

#include <exception>
#include <filesystem>
#include <stdexcept>
#include <string>

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "segmenter/io/labelled_ply_writer.hpp"
#include "segmenter/io/map_files.hpp"
#include "segmenter/io/ply_reader.hpp"
#include "segmenter/options.hpp"
#include "segmenter/preprocess/cloud_preparation.hpp"
#include "segmenter/tools/cloud_slices.hpp"

namespace kintsugi::segmenter {
namespace {

struct Options {
  std::filesystem::path input;
  std::filesystem::path output;
  std::filesystem::path json;
  double resolution_m = 0.0;  // 0: estimated
  std::vector<double> viewpoint_W;
  NormalsConfig normals;
  SegmentMapConfig map;
};

void add_options(CLI::App& app, Options& options) {
  app.add_option("IN", options.input,
                 "a PLY file: x y z, and optionally nx ny nz, red green blue, slice_id")
      ->required();
  app.add_option("OUT", options.output, "the labelled PLY to write")->required();
  app.add_option("--json", options.json, "also write what is known about each segment");
  app.add_option("--resolution", options.resolution_m,
                 "voxel size in metres, > 0 (default: the median spacing of the points)")
      ->check(CLI::PositiveNumber);
  app.add_option("--normals-k", options.normals.num_neighbours,
                 "neighbours for the normals of a cloud without, >= 3")
      ->capture_default_str();
  app.add_option("--viewpoint", options.viewpoint_W,
                 "X Y Z that computed normals face (default: the mean of the points)")
      ->expected(3);
  add_segmentation_options(app, options.map);
}

void validate(Options& options) {
  if (!options.viewpoint_W.empty()) {
    options.normals.viewpoint_W = Eigen::Vector3d(options.viewpoint_W.data());
  }
  options.normals.validate();
  options.map.validate();
  for (const auto& path : {options.output, options.json}) {
    if (path.has_parent_path() && !std::filesystem::is_directory(path.parent_path())) {
      throw std::runtime_error(path.string() + ": there is no folder " +
                               path.parent_path().string());
    }
  }
}

void log_progress(const std::string& what, double share) {
  spdlog::info("{} {:3.0f} %", what, 100.0 * share);
}

void prepare(PlyCloud& cloud, const Options& options) {
  const std::string name = options.input.string();
  if (cloud.points_W.empty()) {
    throw std::runtime_error(name + ": holds no points");
  }
  spdlog::info("{}: {} points, {} normals, {} slice_id", name, cloud.points_W.size(),
               cloud.has_normals ? "with" : "without",
               cloud.slice_ids.empty() ? "without" : "with");
  if (cloud.has_normals) {
    const auto count = normalize_normals(cloud.points_W);
    if (count > 0) {
      spdlog::warn("{}: {} normals were not of unit length and have been scaled", name, count);
    }
  } else {
    compute_normals(cloud.points_W, options.normals,
                    [](double share) { log_progress("normals", share); });
  }
  for (const Rejection& rejection : count_rejections(cloud.points_W)) {
    spdlog::warn("{}: {} points rejected: {} (the first is vertex {})", name, rejection.count,
                 rejection.reason, rejection.first_vertex);
  }
}

float choose_resolution_m(const PlyCloud& cloud, const Options& options) {
  if (options.resolution_m > 0.0) {
    return static_cast<float>(options.resolution_m);
  }
  const float resolution_m = usable_spacing_m(cloud.points_W);
  if (!(resolution_m > 0.0F)) {
    throw std::runtime_error(options.input.string() +
                             ": too few usable points to estimate the resolution from: "
                             "give --resolution");
  }
  spdlog::info("resolution {:.6g} m: the median spacing of the points", resolution_m);
  return resolution_m;
}

void write_labelled_cloud(const SegmentMap& map, const CloudSlices& slices, const PlyCloud& cloud,
                          const Options& options) {
  const auto labels = labels_in_input_order(map, slices);
  LabelledPlyWriter writer(options.output, static_cast<std::int64_t>(cloud.points_W.size()),
                           {"segmented by kintsugi-segment-cloud, mode " + options.map.mode,
                            "segment_id 0: a point that cannot be segmented"});
  for (std::size_t i = 0; i < cloud.points_W.size(); ++i) {
    writer.append(cloud.points_W[i], labels[i], cloud.slice_ids.empty() ? 0 : cloud.slice_ids[i]);
  }
  writer.commit();
  if (!options.json.empty()) {
    write_segments_json(map, options.json);
  }
}

void run(const Options& options) {
  PlyCloud cloud = read_ply(options.input);
  prepare(cloud, options);
  const float resolution_m = choose_resolution_m(cloud, options);
  const CloudSlices slices =
      cut_into_slices(cloud, resolution_m, options.input.filename().string());
  const auto map =
      segment_slices(slices, options.map, [](double share) { log_progress("segmented", share); });
  write_labelled_cloud(*map, slices, cloud, options);
  spdlog::info("{}: {} segments of {} points", options.output.string(),
               map->segment_ids().num_segments(), map->cloud().size());
}

}  // namespace
}  // namespace kintsugi::segmenter

int main(int argc, char** argv) {
  using namespace kintsugi::segmenter;
  spdlog::set_default_logger(spdlog::stderr_color_mt("kintsugi-segment-cloud"));
  spdlog::set_pattern("%^%l%$: %v");
  CLI::App app{"Segments a point cloud from a PLY file (Felzenszwalb and Huttenlocher; Finman)."};
  Options options;
  add_options(app, options);
  CLI11_PARSE(app, argc, argv);
  try {
    validate(options);
    run(options);
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
    return 1;
  }
  return 0;
}
