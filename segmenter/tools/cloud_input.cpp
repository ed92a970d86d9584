#include "segmenter/tools/cloud_input.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>
#include <spdlog/spdlog.h>

#include "segmenter/preprocess/cloud_preparation.hpp"

namespace kintsugi::segmenter {
namespace {

// As the mapper averages those of its surface.
constexpr float kAveragingRadius_vox = 2.0F;

NormalsConfig normals_of(const CloudInputConfig& config) {
  NormalsConfig normals = config.normals;
  if (!config.viewpoint_W.empty()) {
    normals.viewpoint_W = Eigen::Vector3d(config.viewpoint_W.data());
  }
  return normals;
}

float choose_resolution_m(const PlyCloud& cloud, const std::string& name,
                          const CloudInputConfig& config) {
  if (config.resolution_m > 0.0) {
    return static_cast<float>(config.resolution_m);
  }
  const float resolution_m = usable_spacing_m(cloud.points_W);
  if (!(resolution_m > 0.0F)) {
    throw std::runtime_error(name +
                             ": too few usable points to estimate the resolution from: "
                             "give --resolution");
  }
  spdlog::info("resolution {:.6g} m: the median spacing of the points", resolution_m);
  return resolution_m;
}

void log_contents(const PlyCloud& cloud, const std::string& name) {
  const auto is_colored = [](const CloudPoint& p) { return (p.red | p.green | p.blue) != 0; };
  const bool has_colors = std::any_of(cloud.points_W.begin(), cloud.points_W.end(), is_colored);
  spdlog::info("{}: {} points, {} normals, {} slice_id", name, cloud.points_W.size(),
               cloud.has_normals ? "with" : "without",
               cloud.slice_ids.empty() ? "without" : "with");
  if (!has_colors) spdlog::info("{}: without colour: edges are weighed by normals alone", name);
}

void prepare_normals(PlyCloud& cloud, float resolution_m, const std::string& name,
                     const CloudInputConfig& config) {
  if (cloud.has_normals) {
    const auto count = normalize_normals(cloud.points_W);
    if (count > 0) {
      spdlog::warn("{}: {} normals were not of unit length and have been scaled", name, count);
    }
  } else {
    compute_normals(cloud.points_W, normals_of(config),
                    [](double share) { spdlog::info("normals {:3.0f} %", 100.0 * share); });
  }
  if (!cloud.has_normals || config.averages_given_normals) {
    average_normals(cloud.points_W, kAveragingRadius_vox * resolution_m);
  }
}

void log_rejections(const PlyCloud& cloud, const std::string& name) {
  for (const Rejection& rejection : count_rejections(cloud.points_W)) {
    spdlog::warn("{}: {} points rejected: {} (the first is vertex {})", name, rejection.count,
                 rejection.reason, rejection.first_vertex);
  }
}

}  // namespace

void CloudInputConfig::validate() const {
  if (!(resolution_m >= 0.0)) {
    throw std::invalid_argument("resolution_m is " + std::to_string(resolution_m) +
                                ", must be >= 0");
  }
  if (!viewpoint_W.empty() && viewpoint_W.size() != 3) {
    throw std::invalid_argument("viewpoint_W has " + std::to_string(viewpoint_W.size()) +
                                " values, must have 3");
  }
  normals_of(*this).validate();
}

void add_cloud_options(CLI::App& app, CloudInputConfig& config) {
  app.add_option("--resolution", config.resolution_m,
                 "voxel size in metres, > 0 (default: the median spacing of the points)")
      ->check(CLI::PositiveNumber);
  app.add_option("--normals-k", config.normals.num_neighbours,
                 "neighbours for the normals of a cloud without, >= 3")
      ->capture_default_str();
  app.add_flag(
      "--average-normals", config.averages_given_normals,
      "average normals that the cloud brings within two voxels, too, as computed ones are");
  app.add_option("--viewpoint", config.viewpoint_W,
                 "X Y Z that computed normals face (default: the mean of the points)")
      ->expected(3);
}

CloudInput read_cloud(const std::filesystem::path& path, const CloudInputConfig& config) {
  config.validate();
  const std::string name = path.string();
  CloudInput input{read_ply(path), 0.0F};
  if (input.cloud.points_W.empty()) {
    throw std::runtime_error(name + ": holds no points");
  }
  log_contents(input.cloud, name);
  input.resolution_m = choose_resolution_m(input.cloud, name, config);
  prepare_normals(input.cloud, input.resolution_m, name, config);
  log_rejections(input.cloud, name);
  return input;
}

}  // namespace kintsugi::segmenter
