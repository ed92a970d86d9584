#include "mapper/synthetic/render/instance_json.hpp"

#include <nlohmann/json.hpp>

#include "mapper/synthetic/scene/object_model.hpp"

namespace kintsugi::synthetic {

namespace {

nlohmann::ordered_json numbers_of(const Eigen::Vector3d& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

}  // namespace

nlohmann::ordered_json numbers_of(const Pose& pose) {
  auto numbers = nlohmann::ordered_json::array();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) numbers.push_back(pose.matrix()(row, column));
  }
  return numbers;
}

nlohmann::ordered_json symmetry_json(const Instance& instance, const Scene& scene) {
  const Symmetry symmetry = symmetry_of(instance, scene.primitives());
  auto axes = nlohmann::ordered_json::array();
  for (const SymmetryAxis& axis : symmetry.axes) {
    axes.push_back({{"direction_G", numbers_of(axis.direction_G)}, {"order", axis.order}});
  }
  return {{"centre_G", numbers_of(symmetry.centre_G)}, {"axes", axes}};
}

}  // namespace kintsugi::synthetic
