#pragma once
// The model of an object from its points in a map.

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>

#include "lcmtypes/geometry.hpp"
#include "lcmtypes/messages.hpp"
#include "segmenter/objects/model/object_model.hpp"

namespace kintsugi::segmenter {

/// Finer than this no depth camera measures an object across a table.
inline constexpr float kFinestModel_m = 0.005F;

struct MadeModel {
  ObjectModel model;  ///< without views, and with the default parameters
  Pose X_WO = Pose::Identity();
};

/// @param points_W of the object; those that may not be in a map are left out
/// @param resolution_m voxel size of the map, > 0
/// @param up_W unit vector; nothing: the map does not tell which direction is up
/// @throws std::runtime_error when no point is left
MadeModel make_model(const std::string& name, std::span<const CloudPoint> points_W,
                     float resolution_m, const std::optional<Eigen::Vector3d>& up_W);

}  // namespace kintsugi::segmenter
