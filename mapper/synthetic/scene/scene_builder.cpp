#include "mapper/synthetic/scene/scene_builder.hpp"

#include <algorithm>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "mapper/synthetic/scene/object_model.hpp"

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
  instances_.push_back({.id = ++last_id_,
                        .name = name,
                        .model = "",
                        .key = "",
                        .X_WG = X_WG,
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
  primitives_.push_back({shape, instance.X_WG * X_GO, material, instance.id});
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

void SceneBuilder::assign_keys() {
  for (Instance& instance : instances_) {
    if (!instance.key.empty()) continue;
    instance.model = model_of(instance, primitives_);
    const int number = ++num_of_model_[instance.model];
    instance.key = number == 1 ? instance.model : instance.model + " " + std::to_string(number);
  }
}

std::vector<Instance>::iterator SceneBuilder::find(const std::string& key) {
  assign_keys();
  const auto found = std::ranges::find(instances_, key, &Instance::key);
  if (found == instances_.end()) {
    throw std::invalid_argument("SceneBuilder: no object has the key \"" + key + "\"");
  }
  return found;
}

void SceneBuilder::take_away(const std::string& key) {
  const auto instance = find(key);
  std::erase_if(primitives_, [&](const Primitive& p) { return p.instance == instance->id; });
  instances_.erase(instance);
}

void SceneBuilder::move(const std::string& key, const Pose& X_WG) {
  const auto instance = find(key);
  const Pose X_after_before = X_WG * instance->X_WG.inverse();
  for (Primitive& primitive : primitives_) {
    if (primitive.instance == instance->id) primitive.X_WO = X_after_before * primitive.X_WO;
  }
  instance->X_WG = X_WG;
}

Scene SceneBuilder::build(const Color& light) && {
  assign_keys();
  std::map<int, int> new_ids;
  for (Instance& instance : instances_) {
    const int new_id = static_cast<int>(new_ids.size()) + 1;
    new_ids[instance.id] = new_id;
    instance.id = new_id;
  }
  for (Primitive& primitive : primitives_) primitive.instance = new_ids.at(primitive.instance);
  return {std::move(primitives_), std::move(instances_), light};
}

}  // namespace kintsugi::synthetic
