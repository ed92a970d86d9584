#include "mapper/synthetic/scene/scene_builder.hpp"

#include <numbers>
#include <utility>

namespace kintsugi::synthetic {

Pose at(double x, double y, double z, double yaw_rad) {
  Pose X = Pose::Identity();
  X.translation() = Eigen::Vector3d(x, y, z);
  X.linear() = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return X;
}

Pose axis_along_x() {
  return Pose(Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitY()));
}

Pose axis_along_y() {
  return Pose(Eigen::AngleAxisd(-std::numbers::pi / 2, Eigen::Vector3d::UnitX()));
}

Color rgb(int red, int green, int blue) {
  return Color(static_cast<float>(red), static_cast<float>(green), static_cast<float>(blue)) /
         255.0F;
}

Material plain(const Color& color) { return {.texture = Texture::kPlain, .color = color}; }

Material textured(Texture texture, const Color& color, const Color& second_color, double scale_m) {
  return {texture, color, second_color, static_cast<float>(scale_m)};
}

void SceneBuilder::begin(const std::string& name, const Pose& X_WG, bool is_structure) {
  X_WG_ = X_WG;
  instances_.push_back({.id = static_cast<int>(instances_.size()) + 1,
                        .name = name,
                        .shape = "",
                        .is_structure = is_structure});
}

void SceneBuilder::begin_object(const std::string& name, const Pose& X_WG) {
  begin(name, X_WG, false);
}

void SceneBuilder::begin_structure(const std::string& name, const Pose& X_WG) {
  begin(name, X_WG, true);
}

void SceneBuilder::add(const Shape& shape, const Pose& X_GO, const Material& material) {
  Instance& instance = instances_.back();
  if (instance.shape.empty()) {
    instance.shape = shape_name(shape.kind);
    instance.color = material.color;
  }
  primitives_.push_back({shape, X_WG_ * X_GO, material, instance.id});
}

void SceneBuilder::add_object(const std::string& name, const Pose& X_WG, const Shape& shape,
                              const Material& material) {
  begin_object(name, X_WG);
  add(shape, Pose::Identity(), material);
}

void SceneBuilder::add_structure(const std::string& name, const Pose& X_WG, const Shape& shape,
                                 const Material& material) {
  begin_structure(name, X_WG);
  add(shape, Pose::Identity(), material);
}

Scene SceneBuilder::build() && { return {std::move(primitives_), std::move(instances_)}; }

}  // namespace kintsugi::synthetic
