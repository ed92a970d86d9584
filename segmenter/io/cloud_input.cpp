#include "segmenter/io/cloud_input.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "lcmtypes/base/argument_check.hpp"
#include "lcmtypes/base/choice_check.hpp"
#include "lcmtypes/base/logger.hpp"
#include "segmenter/io/formats/cloud_file.hpp"
#include "segmenter/io/points/length_unit.hpp"
#include "segmenter/preprocess/cloud_preparation.hpp"

namespace kintsugi::segmenter {
namespace {

NormalsConfig normals_of(const CloudInputConfig& config, const Eigen::Vector3d& origin_W) {
  NormalsConfig normals = config.normals;
  if (!config.viewpoint_W.empty()) {
    normals.viewpoint_W = Eigen::Vector3d(config.viewpoint_W.data()) - origin_W;
  }
  return normals;
}

/// Rooms are mapped at centimetres, and laser scans of buildings rarely thinned out to decimetres;
/// in millimetres even the finest clouds are 0.25 units apart.
void ask_for_unit(float spacing_m, CloudFormat format, const std::string& name) {
  constexpr float kFarApart_m = 0.25F;
  // LAS files are in metres by convention, and from the air points may be this far apart.
  if (format == CloudFormat::kLas || spacing_m < kFarApart_m) return;
  spdlog::warn(
      "{}: its points are {:.4g} apart, too far for metres: if the unit is millimetres give "
      "--unit mm, if it is metres --unit m",
      name, spacing_m);
}

/// The median spacing of the points.
float find_resolution_m(const FileCloud& cloud, const std::string& name) {
  const float resolution_m = usable_spacing_m(cloud.points_W);
  if (!(resolution_m > 0.0F)) {
    throw std::runtime_error(name +
                             ": too few usable points to estimate the resolution from: "
                             "give --resolution");
  }
  spdlog::info("resolution {:.6g} m: the median spacing of the points", resolution_m);
  return resolution_m;
}

/// The unit that is given, or that the header tells; empty: neither.
std::string choose_unit(const CloudFile& file, const std::string& name,
                        const CloudInputConfig& config) {
  if (!config.unit.empty()) return config.unit;
  std::string unit = unit_told_by(file.table.comments);
  if (!unit.empty()) spdlog::info("{}: its header tells the unit: {}", name, unit);
  return unit;
}

void log_contents(const CloudFile& file, const FileCloud& cloud, const std::string& name) {
  if (file.format != CloudFormat::kPly) {
    std::string columns;
    for (const PointField& field : file.table.fields()) columns += " " + field.name;
    spdlog::info("{}: read as {} with the columns{}", name, name_of(file.format), columns);
  }
  const auto is_colored = [](const CloudPoint& p) { return (p.red | p.green | p.blue) != 0; };
  const bool has_colors = std::any_of(cloud.points_W.begin(), cloud.points_W.end(), is_colored);
  spdlog::info("{}: {} points, {} normals, {} slice_id", name, cloud.points_W.size(),
               cloud.has_normals ? "with" : "without",
               cloud.slice_ids.empty() ? "without" : "with");
  if (!has_colors) spdlog::info("{}: without colour: edges are weighed by normals alone", name);
}

void log_origin(const CloudFile& file, const PointRoles& roles, const Eigen::Vector3d& origin_W,
                const std::string& name) {
  if (origin_W.isZero(0.0)) return;
  spdlog::info(
      "{}: far from its origin: segmented relative to ({:.0f}, {:.0f}, {:.0f}) m; the coordinates "
      "that are written are those of the file",
      name, origin_W.x(), origin_W.y(), origin_W.z());
  if (file.table.fields()[roles.position[0]].type != ScalarType::kFloat32) return;
  const auto farthest = static_cast<float>(origin_W.cwiseAbs().maxCoeff());
  spdlog::warn("{}: has its coordinates as float, in steps of {:.3g} m there: keep them as double",
               name, std::nextafter(farthest, std::numeric_limits<float>::infinity()) - farthest);
}

void compute_all_normals(FileCloud& cloud, float resolution_m, const NormalsConfig& config) {
  compute_normals(cloud.points_W, config,
                  [](double share) { spdlog::info("normals {:3.0f} %", 100.0 * share); });
  average_normals(cloud.points_W, kAveragingRadius_vox * resolution_m);
}

void complete_normals(FileCloud& cloud, float resolution_m, const std::string& name,
                      const CloudInputConfig& config, const NormalsConfig& normals) {
  const auto [num_missing, num_points] = count_missing_normals(cloud.points_W);
  if (num_missing > 0 && num_missing == num_points) {
    spdlog::warn("{}: all normals are zero or not finite: they are computed", name);
    compute_all_normals(cloud, resolution_m, normals);
    return;
  }
  const auto num_scaled = normalize_normals(cloud.points_W);
  if (num_scaled > 0) {
    spdlog::warn("{}: {} normals were not of unit length and have been scaled", name, num_scaled);
  }
  if (num_missing > 0) {
    spdlog::warn("{}: {} normals are zero or not finite: they are computed", name, num_missing);
    compute_missing_normals(cloud.points_W, normals);
  }
  if (config.averages_given_normals) {
    average_normals(cloud.points_W, kAveragingRadius_vox * resolution_m);
  }
}

/// @throws std::runtime_error when no point is left
void log_rejections(const FileCloud& cloud, const std::string& name) {
  std::int64_t num_rejected = 0;
  for (const Rejection& rejection : count_rejections(cloud.points_W)) {
    spdlog::warn("{}: {} points rejected: {} (the first is vertex {})", name, rejection.count,
                 rejection.reason, rejection.first_vertex);
    num_rejected += rejection.count;
  }
  if (num_rejected < std::ssize(cloud.points_W)) return;
  throw std::runtime_error(name + ": none of its " + std::to_string(num_rejected) +
                           " points can be segmented");
}

}  // namespace

void CloudInputConfig::validate() const {
  constexpr std::array<std::string_view, 4> kUnits{"", "m", "cm", "mm"};
  require(resolution_m >= 0.0, "resolution_m", resolution_m, ">= 0");
  require(viewpoint_W.empty() || viewpoint_W.size() == 3,
          "viewpoint_W has " + std::to_string(viewpoint_W.size()) + " values, must have 3");
  require_one_of("unit", unit, kUnits);
  normals_of(*this, Eigen::Vector3d::Zero()).validate();
}

CloudInput read_cloud(const std::filesystem::path& path, const CloudInputConfig& config) {
  config.validate();
  const std::string name = path.string();
  CloudFile file = read_cloud_file(path, config.labels);
  if (file.table.size() == 0) {
    throw std::runtime_error(name + ": holds no points");
  }
  const PointRoles roles = find_roles(file.table, name, config.labels);
  const std::string unit = choose_unit(file, name, config);
  PositionFrame frame{.metres_per_unit = metres_per(unit)};
  if (config.shifts_origin) {
    frame.origin_W = choose_origin_W(file.table, roles, frame.metres_per_unit);
  }
  CloudInput input;
  input.cloud = cloud_of(file.table, roles, frame, name);
  input.origin_W = frame.origin_W;
  log_contents(file, input.cloud, name);
  log_origin(file, roles, frame.origin_W, name);
  input.resolution_m = static_cast<float>(config.resolution_m);
  if (config.resolution_m == 0.0) {
    input.resolution_m = find_resolution_m(input.cloud, name);
    if (unit.empty()) ask_for_unit(input.resolution_m, file.format, name);
  }
  const NormalsConfig normals = normals_of(config, frame.origin_W);
  if (input.cloud.has_normals) {
    complete_normals(input.cloud, input.resolution_m, name, config, normals);
  } else {
    compute_all_normals(input.cloud, input.resolution_m, normals);
  }
  log_rejections(input.cloud, name);
  input.table = std::move(file.table);
  return input;
}

}  // namespace kintsugi::segmenter
