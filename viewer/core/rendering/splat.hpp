#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "viewer/core/rendering/virtual_camera.hpp"
#include "viewer/core/scene/scene.hpp"

namespace kintsugi::viewer {

struct SplatConfig {
  double radius_vox = 1.0;  ///< radius of the disc that stands for a point; surfaces close at 0.71
  double max_radius_px = 24.0;  ///< of a point close to the camera
  double near_m = 0.05;         ///< points closer along V's z are not drawn
  bool cull_back_faces = true;  ///< leave out points whose normal faces away from V

  /// Throws std::invalid_argument naming the field, its value and the bound.
  void validate() const;
};

/// Which point is seen in each pixel, and how far away.
class VisibilityImage {
 public:
  static constexpr std::uint64_t kNothing = ~std::uint64_t{0};

  VisibilityImage(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }
  bool empty(int u, int v) const { return at(u, v) == kNothing; }
  float depth_m(int u, int v) const;      ///< along V's z; of a pixel that is not empty
  std::size_t chunk(int u, int v) const;  ///< index of the chunk that was drawn
  std::size_t point(int u, int v) const;  ///< index of the point in it
  std::uint64_t at(int u, int v) const { return keys_[index(u, v)]; }

  /// Keeps the nearer of what is there and this point; of two at the same depth the one with the
  /// smaller index. May be called from many threads: the result does not depend on their order.
  void keep_nearest(int u, int v, float depth_m, std::uint32_t point_number);

 private:
  std::size_t index(int u, int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(u);
  }

  int width_ = 0;
  int height_ = 0;
  std::vector<std::uint64_t> keys_;  ///< depth as float bits above the point's number
};

/// Draws every point as a disc of radius_vox in its tangent plane, z-buffered. A pixel belongs to
/// the disc when its ray meets it, at the depth where it meets it or up to a quarter of the radius
/// behind (discs are slightly bulged, which settles overlaps on one surface); besides, the pixel at
/// a point's centre always does, so that thin and distant things do not fall between pixels. A
/// point without a unit normal faces the camera. Points that are not finite are not drawn.
///
/// Chunks outside the picture are skipped whole. Runs on all threads of oneTBB; the same picture
/// whatever their number. Throws std::length_error for more than 2^20 chunks.
VisibilityImage splat_points(std::span<const PointChunk> chunks, const VirtualCamera& camera,
                             const SplatConfig& config);

}  // namespace kintsugi::viewer
