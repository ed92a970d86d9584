#include "segmenter/objects/model/make_model.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "segmenter/core/points/transformed_points.hpp"
#include "segmenter/objects/model/merged_points.hpp"

namespace kintsugi::segmenter {
namespace {

/// Points of a map lie a voxel apart, and two layers of one surface less than half of that. Where
/// the map is finer than the model, as many points stay as the model's resolution has: discs of
/// this radius, packed as they come, leave one point for each square of a side of 1 / 0.83 of it.
float merging_reach_m(float map_resolution_m, float model_resolution_m) {
  return map_resolution_m < model_resolution_m ? 0.83F * model_resolution_m
                                               : 0.5F * model_resolution_m;
}

/// z is up_W, and x as near as may be to that of W (or to z of W, if x of W is up).
Eigen::Matrix3d axes_W(const Eigen::Vector3d& up_W) {
  const bool is_x_up = std::abs(up_W.x()) > 0.9;
  const Eigen::Vector3d forward = is_x_up ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX();
  Eigen::Matrix3d R_WO;
  R_WO.col(2) = up_W.normalized();
  R_WO.col(0) = (forward - forward.dot(R_WO.col(2)) * R_WO.col(2)).normalized();
  R_WO.col(1) = R_WO.col(2).cross(R_WO.col(0));
  return R_WO;
}

Eigen::Vector3d mean_of(const std::vector<CloudPoint>& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const CloudPoint& p : points) sum += Eigen::Vector3d(p.x, p.y, p.z);
  return sum / static_cast<double>(points.size());
}

}  // namespace

MadeModel make_model(const std::string& name, std::span<const CloudPoint> points_W,
                     float resolution_m, const std::optional<Eigen::Vector3d>& up_W) {
  MadeModel made;
  made.model.name = name;
  made.model.resolution_m = std::max(resolution_m, kFinestModel_m);
  made.model.has_up = up_W.has_value();
  const std::vector<CloudPoint> merged_W =
      merged_points(points_W, merging_reach_m(resolution_m, made.model.resolution_m));
  if (merged_W.empty()) {
    throw std::runtime_error("none of " + std::to_string(points_W.size()) +
                             " points is usable: a point needs a place and a normal");
  }
  if (up_W.has_value()) made.X_WO.linear() = axes_W(*up_W);
  made.X_WO.translation() = mean_of(merged_W);
  const Pose X_OW = made.X_WO.inverse();
  made.model.points_O.reserve(merged_W.size());
  for (const CloudPoint& p : merged_W) made.model.points_O.push_back(transformed(p, X_OW));
  return made;
}

}  // namespace kintsugi::segmenter
