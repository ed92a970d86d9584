#include "viewer/core/rendering/shade.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <oneapi/tbb/parallel_for.h>

#include "viewer/core/drawing/palette.hpp"

namespace kintsugi::viewer {
namespace {

struct Light {
  float ambient = 0.0F;  ///< share of a colour that a surface seen edge-on keeps
  float edge = 0.0F;     ///< strength of the darkening at edges in depth
};

/// What a point looks like before it is lit.
struct Paint {
  cv::Vec3b color;
  bool is_true = false;  ///< it contains the shading of the room
};

/// A map without colour, and points at which none was seen, have black ones: they are shown grey,
/// and their shape by the light.
Paint paint_of(const CloudPoint& point, std::uint32_t segment_id, Coloring coloring) {
  if (coloring != Coloring::kTrue) return {.color = segment_color(segment_id)};
  if (point.red == 0 && point.green == 0 && point.blue == 0)
    return {.color = palette::kColorlessPoint};
  return {.color = Rgb{point.red, point.green, point.blue}, .is_true = true};
}

/// To true colours less is added.
Light light_of(const Paint& paint) {
  return paint.is_true ? Light{0.75F, 4.0F} : Light{0.45F, 6.0F};
}

/// How much nearer the neighbourhood is than this pixel: mean of max(0, log2 z - log2 z') over the
/// four neighbours two pixels away, each limited so that the background of a near object is
/// outlined and not blackened.
float occlusion(const VisibilityImage& visible, int u, int v) {
  constexpr float kLimit = 0.1F;
  constexpr std::array<std::array<int, 2>, 4> kNeighbours{{{-2, 0}, {2, 0}, {0, -2}, {0, 2}}};
  const float depth_m = visible.depth_m(u, v);
  float sum = 0.0F;
  for (const auto& [du, dv] : kNeighbours) {
    const int x = std::clamp(u + du, 0, visible.width() - 1);
    const int y = std::clamp(v + dv, 0, visible.height() - 1);
    if (visible.empty(x, y)) continue;
    sum += std::clamp(std::log2(depth_m / visible.depth_m(x, y)), 0.0F, kLimit);
  }
  return 0.25F * sum;
}

/// Cosine between a point's normal and the ray back to the eye; 1 without a normal.
float facing(const CloudPoint& p, const Eigen::Vector3f& eye_W) {
  const Eigen::Vector3f normal_W(p.nx, p.ny, p.nz);
  const Eigen::Vector3f to_eye_W = eye_W - Eigen::Vector3f(p.x, p.y, p.z);
  const float length = normal_W.norm() * to_eye_W.norm();
  return length > 0.0F ? std::abs(normal_W.dot(to_eye_W)) / length : 1.0F;
}

}  // namespace

cv::Mat3b shade(const VisibilityImage& visible, std::span<const PointChunk> chunks,
                const VirtualCamera& camera, Coloring coloring, const Highlight& highlight) {
  cv::Mat3b image(visible.height(), visible.width(), palette::kBackground);
  const Eigen::Vector3f eye_W = camera.X_WV.translation().cast<float>();
  tbb::parallel_for(0, visible.height(), [&](int v) {
    for (int u = 0; u < visible.width(); ++u) {
      if (visible.empty(u, v)) continue;
      const PointChunk& chunk = chunks[visible.chunk(u, v)];
      const std::size_t index = visible.point(u, v);
      const CloudPoint& point = chunk.points_W[index];
      const std::uint32_t id = chunk.labels[index];
      const Paint paint = paint_of(point, id, coloring);
      const Light light = light_of(paint);
      const float brightness = (light.ambient + (1.0F - light.ambient) * facing(point, eye_W)) *
                               std::exp(-light.edge * occlusion(visible, u, v));
      const cv::Vec3b lit = cv::Vec3f(paint.color) * brightness;
      image(v, u) = highlight.empty() || highlight.contains(id) ? lit : dimmed(lit);
    }
  });
  return image;
}

}  // namespace kintsugi::viewer
