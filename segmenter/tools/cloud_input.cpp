#include "segmenter/tools/cloud_input.hpp"

#include <stdexcept>
#include <string>

#include <spdlog/spdlog.h>

#include "segmenter/preprocess/cloud_preparation.hpp"

namespace kintsugi::segmenter {
namespace {

NormalsConfig normals_of(const CloudInputConfig& config) {
  NormalsConfig normals = config.normals;
  if (!config.viewpoint_W.empty()) {
    normals.viewpoint_W = Eigen::Vector3d(config.viewpoint_W.data());
  }
  return normals;
}

void prepare(PlyCloud& cloud, const std::string& name, const CloudInputConfig& config) {
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
    compute_normals(cloud.points_W, normals_of(config),
                    [](double share) { spdlog::info("normals {:3.0f} %", 100.0 * share); });
  }
  for (const Rejection& rejection : count_rejections(cloud.points_W)) {
    spdlog::warn("{}: {} points rejected: {} (the first is vertex {})", name, rejection.count,
                 rejection.reason, rejection.first_vertex);
  }
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
  app.add_option("--viewpoint", config.viewpoint_W,
                 "X Y Z that computed normals face (default: the mean of the points)")
      ->expected(3);
}

CloudInput read_cloud(const std::filesystem::path& path, const CloudInputConfig& config) {
  config.validate();
  CloudInput input{read_ply(path), 0.0F};
  prepare(input.cloud, path.string(), config);
  input.resolution_m = choose_resolution_m(input.cloud, path.string(), config);
  return input;
}

}  // namespace kintsugi::segmenter
