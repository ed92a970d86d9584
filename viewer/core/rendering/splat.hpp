#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "viewer/core/camera/virtual_camera.hpp"
#include "viewer/core/map/point_chunk.hpp"
#include "viewer/core/rendering/measured_depth.hpp"

namespace kintsugi::viewer {

struct SplatConfig {
  double radius_vox = 1.0;      ///< of the disc drawn for a point; surfaces have no holes from 0.71
  double max_radius_px = 24.0;  ///< limit for points close to the camera
  double min_radius_px = 0.5;   ///< of smaller discs only the pixel at their centre is drawn
  double near_m = 0.05;         ///< points nearer along V's z are not drawn
  bool cull_back_faces = true;  ///< skip points whose normal faces away from V

  /// @throws std::invalid_argument naming the field, its value and the bound
  void validate() const;
};

/// The z-buffer: which point is visible in each pixel, and its depth.
class VisibilityImage {
 public:
  static constexpr std::uint64_t kNothing = ~std::uint64_t{0};

  VisibilityImage(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }
  bool empty(int u, int v) const { return at(u, v) == kNothing; }
  // Of a pixel that is not empty:
  float depth_m(int u, int v) const;      ///< along V's z
  std::size_t chunk(int u, int v) const;  ///< index of the point's chunk
  std::size_t point(int u, int v) const;  ///< index of the point in its chunk
  /// Depth and point in one number, kNothing in an empty pixel; smaller is nearer.
  std::uint64_t at(int u, int v) const { return keys_[index(u, v)]; }

  /// Keeps the nearer of the pixel's point and this one, of two at the same depth the one with the
  /// smaller number. Threads may call it concurrently: the result does not depend on their order.
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

/// Draws every point as a disc of radius_vox in its tangent plane, with a z-buffer.
///
/// A pixel is covered by a disc when its ray meets the disc. Its depth is that of the intersection
/// plus up to a quarter of the radius towards the rim: discs bulge towards the camera, so that of
/// overlapping discs of one surface the one with the nearest centre is visible. The pixel at the
/// projection of a point is always covered, so that thin and distant objects do not vanish between
/// pixels. A point without a unit normal faces the camera. Points that are not finite are skipped,
/// and so are whole chunks outside the picture.
///
/// Runs on all threads of oneTBB; the result does not depend on their number.
/// @param measured nullptr, or of the picture's size: a point is then drawn only in pixels where it
///   agrees with what is measured
/// @throws std::length_error for more than 2^20 chunks
VisibilityImage splat_points(std::span<const PointChunk> chunks, const VirtualCamera& camera,
                             const SplatConfig& config, const MeasuredDepth* measured = nullptr);

}  // namespace kintsugi::viewer
