#pragma once
// Builds scenes from objects, and objects from solids.

#include <map>
#include <string>
#include <vector>

#include "mapper/synthetic/scene/scene.hpp"

namespace kintsugi::synthetic {

/// Translation, then rotation about z.
Pose at(double x, double y, double z, double yaw_rad = 0.0);

/// Rotations that turn the axis (z) of a solid to x or y.
Pose axis_along_x();
Pose axis_along_y();

Color rgb(int red, int green, int blue);  ///< 0 to 255

Material plain(const Color& color);
Material textured(Texture texture, const Color& color, const Color& second_color, double scale_m);

class SceneBuilder {
 public:
  /// Begins an object with its own frame G; the solids added next belong to it.
  void begin_object(const std::string& name, const Pose& X_WG);

  /// Likewise for a part of the building.
  void begin_structure(const std::string& name, const Pose& X_WG);

  /// Adds a solid to the object begun last. Shape and colour of the object are those of its first.
  void add(const Shape& shape, const Pose& X_GO, const Material& material);

  /// Adds an object, or a part of the building, that is a single solid.
  void add_object(const std::string& name, const Pose& X_WG, const Shape& shape,
                  const Material& material);
  void add_structure(const std::string& name, const Pose& X_WG, const Shape& shape,
                     const Material& material);

  // Of the objects that were added so far, by Instance::key. Those of the others stay as they are.
  // @throws std::invalid_argument if no object has this key
  void take_away(const std::string& key);
  void move(const std::string& key, const Pose& X_WG);

  /// @param light as for Scene
  Scene build(const Color& light = Color::Ones()) &&;

 private:
  void begin(const std::string& name, const Pose& X_WG, bool is_structure);
  void assign_keys();
  std::vector<Instance>::iterator find(const std::string& key);

  std::vector<Primitive> primitives_;
  std::vector<Instance> instances_;  // not always numbered without gaps
  int last_id_ = kNoInstance;
  std::map<std::string, int> num_of_model_;  // that were ever added and have keys
};

}  // namespace kintsugi::synthetic
