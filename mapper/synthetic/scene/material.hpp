#pragma once
// Appearance of surfaces: procedural textures and static lights.

#include <Eigen/Core>
#include <cstdint>

#include "mapper/synthetic/scene/shape.hpp"

namespace kintsugi::synthetic {

using Color = Eigen::Vector3f;  ///< red, green, blue in [0, 1]

enum class Texture : std::uint8_t {
  kPlain,
  kPlaster,  ///< faint mottling, so that walls have texture
  kWood,     ///< grain along the longer side
  kCarpet,   ///< fine speckle
  kBrick,    ///< courses of bricks, mortar in the second colour
  kChecks,   ///< two colours
  kStripes,  ///< two colours, across the second surface coordinate
  kTiles,    ///< grout in the second colour
  kKeys,     ///< keyboard: keys in the second colour
  kScreen,   ///< a monitor that shows windows of text
  kPicture,  ///< a poster: coloured blobs
  kBands,    ///< a label: one band of the second colour around the middle
};

struct Material {
  Texture texture = Texture::kPlain;
  Color color = Color::Constant(0.7F);
  Color second_color = Color::Constant(0.3F);
  float scale_m = 0.1F;  ///< size of one element of the texture
};

/// Colour of the texture at a surface point of `shape`, before light.
Color albedo(const Material& material, const BasicShape<float>& shape, const Eigen::Vector3f& p_O,
             const Eigen::Vector3f& normal_O);

/// Factor of the albedo under the fixed lights: ambient and two directions, Lambertian reflection.
float irradiance(const Eigen::Vector3f& normal_W);

}  // namespace kintsugi::synthetic
