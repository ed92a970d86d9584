#pragma once
// Scenes are put together from objects, objects from solids.

#include <string>
#include <vector>

#include "mapper/synthetic/scene/scene.hpp"

namespace kintsugi::synthetic {

/// Translation, then rotation about z.
Pose at(double x, double y, double z, double yaw_rad = 0.0);

/// Rotations that lay a solid's axis (z) along x or y.
Pose axis_along_x();
Pose axis_along_y();

Color rgb(int red, int green, int blue);  ///< 0 to 255

Material plain(const Color& color);
Material textured(Texture texture, const Color& color, const Color& second_color, double scale_m);

class SceneBuilder {
 public:
  /// Starts an object whose own frame is G: the solids added next belong to it.
  void begin_object(const std::string& name, const Pose& X_WG);

  /// The same for a part of the building.
  void begin_structure(const std::string& name, const Pose& X_WG);

  /// Adds a solid to the object begun last; its name, shape and colour are those of its first.
  void add(const Shape& shape, const Pose& X_GO, const Material& material);

  /// Both in one, for an object or a part of the building that is a single solid.
  void add_object(const std::string& name, const Pose& X_WG, const Shape& shape,
                  const Material& material);
  void add_structure(const std::string& name, const Pose& X_WG, const Shape& shape,
                     const Material& material);

  Scene build() &&;

 private:
  void begin(const std::string& name, const Pose& X_WG, bool is_structure);

  Pose X_WG_ = Pose::Identity();
  std::vector<Primitive> primitives_;
  std::vector<Instance> instances_;
};

}  // namespace kintsugi::synthetic
