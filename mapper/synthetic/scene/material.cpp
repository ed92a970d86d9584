#include "mapper/synthetic/scene/material.hpp"

#include <algorithm>
#include <cmath>

#include "mapper/synthetic/scene/counter_random.hpp"

namespace kintsugi::synthetic {

namespace {

/// In [0, 1), one value for each cell of a grid.
float hash_cell(int x, int y, std::uint32_t salt) {
  const auto mixed = static_cast<std::uint32_t>(x) * 0x8da6b343U +
                     static_cast<std::uint32_t>(y) * 0xd8163841U + salt * 0xcb1ab31fU;
  return unit_float(hash32(mixed));
}

float fraction(float x) { return x - std::floor(x); }

/// Smooth noise in [0, 1] with one random value per unit cell.
float value_noise(float x, float y, std::uint32_t salt) {
  const float fx = std::floor(x);
  const float fy = std::floor(y);
  const int ix = static_cast<int>(fx);
  const int iy = static_cast<int>(fy);
  const float u = (x - fx) * (x - fx) * (3.0F - 2.0F * (x - fx));
  const float v = (y - fy) * (y - fy) * (3.0F - 2.0F * (y - fy));
  const float low = std::lerp(hash_cell(ix, iy, salt), hash_cell(ix + 1, iy, salt), u);
  const float high = std::lerp(hash_cell(ix, iy + 1, salt), hash_cell(ix + 1, iy + 1, salt), u);
  return std::lerp(low, high, v);
}

/// Two coordinates on the surface, metres: on a flat face the two axes of O in it, the longer
/// side of the solid first; around a round solid, angle times radius and height.
Eigen::Vector2f surface_coordinates(const BasicShape<float>& shape, const Eigen::Vector3f& p,
                                    const Eigen::Vector3f& normal) {
  const bool flat = shape.kind == ShapeKind::kBox || shape.kind == ShapeKind::kRoundedBox;
  if (!flat && std::abs(normal.z()) < 0.9F) {
    return {std::atan2(p.y(), p.x()) * shape.half_extents.x(), p.z()};
  }
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  int a = axis == 0 ? 1 : 0;
  int b = axis == 2 ? 1 : 2;
  if (axis == 2 && shape.half_extents[b] > shape.half_extents[a]) std::swap(a, b);
  return {p[a], p[b]};
}

float brick_share(float x, float y, float size) {  // bricks are 2 x 1 x (2/3)
  const float row = std::floor(y / (size * 0.5F));
  const float along = x / size + (static_cast<int>(row) % 2 != 0 ? 0.5F : 0.0F);
  const bool mortar = fraction(along) < 0.04F || fraction(y / (size * 0.5F)) < 0.08F;
  if (mortar) return 1.0F;
  return 0.35F * hash_cell(static_cast<int>(std::floor(along)), static_cast<int>(row), 7);
}

Color screen(float x, float y, const Material& m) {
  const float line = y / 0.012F;
  const float row = std::floor(line);
  const float length = 0.02F + 0.1F * hash_cell(static_cast<int>(row), 3, 5);
  const float along = fraction(x / 0.16F) * 0.16F;
  const bool text = fraction(line) > 0.45F && along > 0.012F && along < length &&
                    hash_cell(static_cast<int>(x / 0.006F), static_cast<int>(row), 9) > 0.2F;
  return text ? m.second_color : m.color;
}

}  // namespace

Color albedo(const Material& m, const BasicShape<float>& shape, const Eigen::Vector3f& p_O,
             const Eigen::Vector3f& normal_O) {
  if (m.texture == Texture::kPlain) return m.color;
  const Eigen::Vector2f uv = surface_coordinates(shape, p_O, normal_O);
  const float x = uv.x();
  const float y = uv.y();
  const float s = m.scale_m;
  const auto mix = [&m](float share) -> Color {
    return m.color + share * (m.second_color - m.color);
  };
  const auto cell = [s](float v) { return static_cast<int>(std::floor(v / s)); };
  switch (m.texture) {
    case Texture::kPlain:
      return m.color;
    case Texture::kPlaster:
      return m.color * (0.94F + 0.06F * value_noise(x / s, y / s, 1));
    case Texture::kWood: {
      const float warp = value_noise(x / (8 * s), y / (2 * s), 2);
      return mix(0.6F * fraction(y / s + 3.0F * warp) +
                 0.4F * value_noise(x / (2 * s), y * 8 / s, 3));
    }
    case Texture::kCarpet:
      return mix(0.7F * hash_cell(cell(x), cell(y), 4) + 0.3F * value_noise(x * 3, y * 3, 5));
    case Texture::kBrick:
      return mix(brick_share(x, y, s));
    case Texture::kChecks:
      return mix(static_cast<float>((cell(x) + cell(y)) & 1));
    case Texture::kStripes:
      return mix(static_cast<float>(cell(y) & 1));
    case Texture::kTiles: {
      const bool grout = fraction(x / s) < 0.03F || fraction(y / s) < 0.03F;
      return grout ? m.second_color
                   : Color(m.color * (0.92F + 0.08F * hash_cell(cell(x), cell(y), 6)));
    }
    case Texture::kKeys: {
      const bool gap = normal_O.z() < 0.5F || fraction(x / s) < 0.15F || fraction(y / s) < 0.15F;
      return gap ? m.color : m.second_color;
    }
    case Texture::kScreen:
      return screen(x, y, m);
    case Texture::kPicture: {
      const float blobs =
          value_noise(x / s, y / s, 8) + 0.5F * value_noise(2 * x / s, 2 * y / s, 9);
      return mix(blobs > 0.85F ? 1.0F : (blobs > 0.65F ? 0.5F : 0.0F));
    }
    case Texture::kBands:
      return mix(std::abs(p_O.z()) < 0.35F * shape.half_extents.z() ? 1.0F : 0.0F);
  }
  return m.color;
}

float irradiance(const Eigen::Vector3f& normal_W) {
  static const Eigen::Vector3f kKey = Eigen::Vector3f(0.38F, -0.50F, 0.78F).normalized();
  static const Eigen::Vector3f kFill = Eigen::Vector3f(-0.70F, 0.65F, 0.30F).normalized();
  return std::min(1.0F, 0.56F + 0.40F * std::max(0.0F, normal_W.dot(kKey)) +
                            0.25F * std::max(0.0F, normal_W.dot(kFill)));
}

}  // namespace kintsugi::synthetic
