#include "viewer/core/rendering/splat.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <string>

#include <oneapi/tbb/parallel_for.h>

#include "lcmtypes/base/argument_check.hpp"

namespace kintsugi::viewer {
namespace {

constexpr int kPointBits = std::countr_zero(PointChunk::kMaxPoints);
static_assert(std::has_single_bit(PointChunk::kMaxPoints));
constexpr std::size_t kMaxChunks = std::size_t{1} << (32 - kPointBits);

/// Discs bulge towards the camera by this part of their radius, so that where two of one surface
/// overlap a pixel shows the point it is nearer to, not whichever plane happens to be in front.
constexpr float kBulge = 0.25F;

/// Projects points; in single precision for speed.
class Projector {
 public:
  Projector(const VirtualCamera& camera, const SplatConfig& config, const MeasuredDepth* measured)
      : R_VW_(camera.X_WV.linear().transpose().cast<float>()),
        eye_W_(camera.X_WV.translation().cast<float>()),
        fx_(static_cast<float>(camera.intrinsics.fx)),
        fy_(static_cast<float>(camera.intrinsics.fy)),
        cx_(static_cast<float>(camera.intrinsics.cx)),
        cy_(static_cast<float>(camera.intrinsics.cy)),
        config_(config),
        measured_(measured) {}

  bool may_see(const Eigen::AlignedBox3f& box_W, float radius_m,
               const VisibilityImage& image) const;
  void draw(const PointChunk& chunk, std::uint32_t first_number, VisibilityImage& image) const;

 private:
  void draw_disc(const Eigen::Vector3f& p_V, const Eigen::Vector3f& n_V, float radius_m,
                 std::uint32_t number, VisibilityImage& image) const;
  bool may_be_at(int u, int v, float depth_m, float radius_m) const {
    const auto voxels = static_cast<float>(config_.radius_vox);
    return measured_ == nullptr || measured_->agrees(u, v, depth_m, radius_m / voxels);
  }

  Eigen::Matrix3f R_VW_;
  Eigen::Vector3f eye_W_;
  float fx_, fy_, cx_, cy_;
  SplatConfig config_;
  const MeasuredDepth* measured_;
};

/// False when all corners are beyond the same side of the picture or nearer than near_m.
bool Projector::may_see(const Eigen::AlignedBox3f& box_W, float radius_m,
                        const VisibilityImage& image) const {
  if (box_W.isEmpty()) return false;
  const Eigen::Vector3f margin = Eigen::Vector3f::Constant(radius_m);
  const Eigen::AlignedBox3f grown_W(box_W.min() - margin, box_W.max() + margin);
  bool behind = true, left = true, right = true, above = true, below = true;
  for (int i = 0; i < 8; ++i) {
    const auto type = static_cast<Eigen::AlignedBox3f::CornerType>(i);
    const Eigen::Vector3f p_V = R_VW_ * (grown_W.corner(type) - eye_W_);
    const float u_z = fx_ * p_V.x() + (cx_ + 1.0F) * p_V.z();  // (u + 1) z: one pixel to spare
    const float v_z = fy_ * p_V.y() + (cy_ + 1.0F) * p_V.z();
    behind = behind && p_V.z() < static_cast<float>(config_.near_m);
    left = left && u_z < 0.0F;
    above = above && v_z < 0.0F;
    right = right && u_z > static_cast<float>(image.width() + 1) * p_V.z();
    below = below && v_z > static_cast<float>(image.height() + 1) * p_V.z();
  }
  return !(behind || left || right || above || below);
}

void Projector::draw(const PointChunk& chunk, std::uint32_t first_number,
                     VisibilityImage& image) const {
  const float radius_m = static_cast<float>(config_.radius_vox) * chunk.resolution_m;
  for (std::size_t i = 0; i < chunk.points_W.size(); ++i) {
    const CloudPoint& p = chunk.points_W[i];
    const Eigen::Vector3f offset_W = Eigen::Vector3f(p.x, p.y, p.z) - eye_W_;
    Eigen::Vector3f normal_W(p.nx, p.ny, p.nz);
    if (!(std::abs(normal_W.squaredNorm() - 1.0F) < 0.1F)) normal_W = -offset_W.normalized();
    if (config_.cull_back_faces && offset_W.dot(normal_W) >= 0.0F) continue;
    const Eigen::Vector3f p_V = R_VW_ * offset_W;
    if (!(p_V.z() >= static_cast<float>(config_.near_m))) continue;
    draw_disc(p_V, R_VW_ * normal_W, radius_m, first_number + static_cast<std::uint32_t>(i), image);
  }
}

void Projector::draw_disc(const Eigen::Vector3f& p_V, const Eigen::Vector3f& n_V, float radius_m,
                          std::uint32_t number, VisibilityImage& image) const {
  const float inverse_z = 1.0F / p_V.z();
  const float u = fx_ * p_V.x() * inverse_z + cx_;
  const float v = fy_ * p_V.y() * inverse_z + cy_;
  const float radius_px = std::min(std::max(fx_, fy_) * radius_m * inverse_z,
                                   static_cast<float>(config_.max_radius_px));
  if (!(u > -radius_px - 1.0F && u < static_cast<float>(image.width()) + radius_px &&
        v > -radius_px - 1.0F && v < static_cast<float>(image.height()) + radius_px)) {
    return;
  }
  const int center_u = static_cast<int>(std::lround(u));
  const int center_v = static_cast<int>(std::lround(v));
  if (center_u >= 0 && center_u < image.width() && center_v >= 0 && center_v < image.height() &&
      may_be_at(center_u, center_v, p_V.z(), radius_m)) {
    image.keep_nearest(center_u, center_v, p_V.z(), number);
  }
  if (radius_px < static_cast<float>(config_.min_radius_px)) return;

  // The disc's nearest edge looks larger than its middle: at most by z / (z - r).
  const float reach_px = radius_px * p_V.z() / std::max(p_V.z() - radius_m, 0.5F * p_V.z());
  const int first_u = std::max(0, static_cast<int>(std::ceil(u - reach_px)));
  const int last_u = std::min(image.width() - 1, static_cast<int>(std::floor(u + reach_px)));
  const int first_v = std::max(0, static_cast<int>(std::ceil(v - reach_px)));
  const int last_v = std::min(image.height() - 1, static_cast<int>(std::floor(v + reach_px)));
  const float plane = n_V.dot(p_V);
  for (int y = first_v; y <= last_v; ++y) {
    for (int x = first_u; x <= last_u; ++x) {
      const Eigen::Vector3f ray((static_cast<float>(x) - cx_) / fx_,
                                (static_cast<float>(y) - cy_) / fy_, 1.0F);
      const float depth_m = plane / n_V.dot(ray);
      const float distance2_m2 = (ray * depth_m - p_V).squaredNorm();
      if (!(distance2_m2 <= radius_m * radius_m && depth_m > 0.0F)) continue;
      if (!may_be_at(x, y, depth_m, radius_m)) continue;
      image.keep_nearest(x, y, depth_m + kBulge * distance2_m2 / radius_m, number);
    }
  }
}

}  // namespace

void SplatConfig::validate() const {
  require(radius_vox > 0.0 && radius_vox <= 10.0, "SplatConfig::radius_vox", radius_vox,
          "in (0, 10]");
  check_range("SplatConfig::max_radius_px", max_radius_px, 1.0, 1000.0);
  check_range("SplatConfig::min_radius_px", min_radius_px, 0.0, 10.0);
  require(near_m > 0.0 && near_m <= 10.0, "SplatConfig::near_m", near_m, "in (0, 10]");
}

VisibilityImage::VisibilityImage(int width, int height)
    : width_(width),
      height_(height),
      keys_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), kNothing) {}

float VisibilityImage::depth_m(int u, int v) const {
  return std::bit_cast<float>(static_cast<std::uint32_t>(at(u, v) >> 32));
}

std::size_t VisibilityImage::chunk(int u, int v) const {
  return static_cast<std::uint32_t>(at(u, v)) >> kPointBits;
}

std::size_t VisibilityImage::point(int u, int v) const {
  return static_cast<std::uint32_t>(at(u, v)) & (PointChunk::kMaxPoints - 1);
}

void VisibilityImage::keep_nearest(int u, int v, float depth_m, std::uint32_t point_number) {
  // The bits of positive floats are ordered as the floats are, so one comparison of the key orders
  // by depth, then by point.
  const std::uint64_t key =
      (std::uint64_t{std::bit_cast<std::uint32_t>(depth_m)} << 32) | point_number;
  const std::atomic_ref<std::uint64_t> pixel(keys_[index(u, v)]);
  std::uint64_t present = pixel.load(std::memory_order_relaxed);
  while (key < present && !pixel.compare_exchange_weak(present, key, std::memory_order_relaxed)) {
  }
}

VisibilityImage splat_points(std::span<const PointChunk> chunks, const VirtualCamera& camera,
                             const SplatConfig& config, const MeasuredDepth* measured) {
  if (chunks.size() > kMaxChunks) {
    throw std::length_error("the picture has " + std::to_string(chunks.size()) +
                            " chunks of points, must be at most " + std::to_string(kMaxChunks));
  }
  VisibilityImage image(camera.intrinsics.width, camera.intrinsics.height);
  const Projector projector(camera, config, measured);
  tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t i) {
    const PointChunk& chunk = chunks[i];
    const float radius_m = static_cast<float>(config.radius_vox) * chunk.resolution_m;
    if (!projector.may_see(chunk.box_W, radius_m, image)) return;
    projector.draw(chunk, static_cast<std::uint32_t>(i << kPointBits), image);
  });
  return image;
}

}  // namespace kintsugi::viewer
