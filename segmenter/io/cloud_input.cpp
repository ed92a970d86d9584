#include "segmenter/io/cloud_input.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include <spdlog/spdlog.h>

#include "lcmtypes/base/argument_check.hpp"
#include "segmenter/preprocess/cloud_preparation.hpp"

namespace kintsugi::segmenter {
namespace {

// The same as in the mapper.
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
  require(resolution_m >= 0.0, "resolution_m", resolution_m, ">= 0");
  require(viewpoint_W.empty() || viewpoint_W.size() == 3,
          "viewpoint_W has " + std::to_string(viewpoint_W.size()) + " values, must have 3");
  normals_of(*this).validate();
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
