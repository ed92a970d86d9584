#pragma once
// SumPhotometryRows over any pack: sixteen pixels of the new frame at a time.

#include "mapper/core/kernels/photometry.hpp"
#include "mapper/core/simd/depth_sigma.hpp"
#include "mapper/core/simd/pixel_rows.hpp"
#include "mapper/core/simd/vector_lanes.hpp"

namespace kintsugi::mapper {

template <typename Pack>
class RowPhotometry {
 public:
  explicit RowPhotometry(const PhotometryInput& input) : in_(input) {
    for (Float& product : products_) product = Float(0.0F);
    for (Float& product : cross_products_) product = Float(0.0F);
  }

  void add_row(int v) {
    for_pixels_of_row<Pack>(in_.surface_C.camera, v, [this](int pixel, int u, float y, int count) {
      add_pixels(pixel, u, y, count);
    });
  }

  PhotometrySums sums() const {
    PhotometrySums result;
    for (int k = 0; k < PhotometrySums::kNumProducts; ++k) {
      result.products[k] = reduce_add(products_[k]);
    }
    for (int k = 0; k < PhotometrySums::kNumCrossProducts; ++k) {
      result.cross_products[k] = reduce_add(cross_products_[k]);
    }
    result.squared_residuals = reduce_add(squared_residuals_);
    for (int k = 0; k < 2; ++k) {
      result.moments_C[k] = reduce_add(moments_C_[k]);
      result.moments_K[k] = reduce_add(moments_K_[k]);
    }
    result.pixels = pixels_;
    return result;
  }

 private:
  using Float = typename Pack::Float;
  using Int = typename Pack::Int;
  using Mask = typename Pack::Mask;
  using Vector = VectorLanes<Float>;

  /// Interpolated value and gradient of an image.
  struct Intensity {
    Float value, gradient_u, gradient_v;
  };

  /// Adds `count` pixels of a row: `pixel` is the index of the first, `u` its column; their rays
  /// are (x, y, 1).
  void add_pixels(int pixel, int u, float y, int count) {
    const PinholeCamera& camera = in_.surface_C.camera;
    // False for NaN, and for lanes beyond the row's end, which are zero.
    const Float depth = Float::load(in_.surface_C.depth_m + pixel, count);
    const Mask is_measured = depth > Float(0.0F);
    if (none(is_measured)) return;
    const Float x = ray_x<Pack>(camera, u);
    const Vector point_V = moved(in_.X_VC, Vector{depth * x, depth * Float(y), depth});
    const Vector point_K = moved(in_.X_KV, point_V);
    const Float inverse_z_K = Float(1.0F) / point_K.z;
    const Vector ray_K = {point_K.x * inverse_z_K, point_K.y * inverse_z_K, Float(1.0F)};
    const Float u_K = ray_K.x * Float(in_.surface_K.camera.fx) + Float(in_.surface_K.camera.cx);
    const Float v_K = ray_K.y * Float(in_.surface_K.camera.fy) + Float(in_.surface_K.camera.cy);
    const Mask is_seen = is_measured & is_visible(point_K.z, u_K, v_K);
    if (none(is_seen)) return;

    const Intensity seen = interpolate(u_K, v_K, is_seen);
    const Intensity here = {Float::load(in_.intensity_C.value + pixel, count),
                            Float::load(in_.intensity_C.gradient_u + pixel, count),
                            Float::load(in_.intensity_C.gradient_v + pixel, count)};
    const Vector by_point_K = by_point(in_.surface_K.camera, seen, ray_K, inverse_z_K);
    const Vector by_point_C =
        by_point(camera, here, {x, Float(y), Float(1.0F)}, Float(1.0F) / depth);
    const Vector by_point_V = rotated_back(in_.X_KV, by_point_K);
    const Vector other_by_point_V = rotated(in_.X_VC, by_point_C);
    add_products(point_V, by_point_V, other_by_point_V, here.value, seen.value, is_seen);
  }

  /// Of points in K: whether the reference sees them, at (u, v), where it can be interpolated.
  Mask is_visible(const Float& z, const Float& u, const Float& v) const {
    const PinholeCamera& camera = in_.surface_K.camera;
    const Float one(1.0F);
    const Mask is_in_view = (z > Float(0.0F)) &
                            ((u >= one) & (u < Float(static_cast<float>(camera.width - 2)))) &
                            ((v >= one) & (v < Float(static_cast<float>(camera.height - 2))));
    const Float half(0.5F);  // rounding to the nearest pixel becomes truncation
    const Int nearest = to_int(v + half) * Int(camera.width) + to_int(u + half);
    const Float depth = gather(in_.surface_K.depth_m, nearest, is_in_view);
    const Float allowed =
        max(Float(in_.depth_sigmas) * depth_sigma_m(in_.variance, z), Float(in_.min_depth_step_m));
    return is_in_view & (abs(depth - z) < allowed);  // false for a NaN
  }

  Intensity interpolate(const Float& u, const Float& v, const Mask& is_seen) const {
    const int width = in_.surface_K.camera.width;
    const Int column = to_int(u);
    const Int row = to_int(v);
    const Float right = u - to_float(column);
    const Float below = v - to_float(row);
    const Float left = Float(1.0F) - right;
    const Float above = Float(1.0F) - below;
    const Int pixel = row * Int(width) + column;
    const auto mix = [&](const float* image) {
      const Float upper =
          left * gather(image, pixel, is_seen) + right * gather(image + 1, pixel, is_seen);
      const Float lower = left * gather(image + width, pixel, is_seen) +
                          right * gather(image + width + 1, pixel, is_seen);
      return above * upper + below * lower;
    };
    return {mix(in_.intensity_K.value), mix(in_.intensity_K.gradient_u),
            mix(in_.intensity_K.gradient_v)};
  }

  /// Derivative of an image's intensity with respect to the points that it shows, on these rays.
  static Vector by_point(const PinholeCamera& camera, const Intensity& intensity, const Vector& ray,
                         const Float& inverse_z) {
    const Float du = intensity.gradient_u * Float(camera.fx) * inverse_z;
    const Float dv = intensity.gradient_v * Float(camera.fy) * inverse_z;
    return {du, dv, Float(0.0F) - (du * ray.x + dv * ray.y)};
  }

  /// Intensities `value` of the new frame and `seen` of the reference, and their derivatives by the
  /// point. d(se3_retract(xi) p)/dxi = [I, -[p]x], so an intensity that changes by a with the
  /// point changes by a for the translation and by p x a for the rotation.
  void add_products(const Vector& point, const Vector& a, const Vector& other_a, const Float& value,
                    const Float& seen, const Mask& is_seen) {
    const Float zero(0.0F);
    const Float residual = seen - Float(in_.gain) * value - Float(in_.bias);
    const Float size = abs(residual);
    const Float limit(in_.full_weight_up_to);
    const Float full(in_.weight);
    const Float weight = select(is_seen, select(size <= limit, full, full * limit / size), zero);
    const Vector moment = cross(point, a);
    const Vector other_moment = cross(point, other_a);
    const Float gain(in_.gain);
    const Float q[8] = {select(is_seen, a.x, zero),      select(is_seen, a.y, zero),
                        select(is_seen, a.z, zero),      select(is_seen, moment.x, zero),
                        select(is_seen, moment.y, zero), select(is_seen, moment.z, zero),
                        select(is_seen, residual, zero), Float(1.0F)};
    const Float other[6] = {other_a.x,      other_a.y,      other_a.z,
                            other_moment.x, other_moment.y, other_moment.z};
    Float weighted[8];
    Float weighted_other[6];
    for (int i = 0; i < 8; ++i) weighted[i] = weight * q[i];
    for (int i = 0; i < 6; ++i) {
      weighted_other[i] = select(is_seen, weight * gain * other[i], zero);
    }
    int k = 0;
#pragma GCC unroll 8
    for (int i = 0; i < 8; ++i) {
#pragma GCC unroll 8
      for (int j = i; j < 8; ++j, ++k) products_[k] = products_[k] + weighted[i] * q[j];
    }
    k = 0;
#pragma GCC unroll 6
    for (int i = 0; i < 6; ++i) {
#pragma GCC unroll 6
      for (int j = i; j < 6; ++j, ++k) {
        cross_products_[k] =
            cross_products_[k] + (q[i] * weighted_other[j] + q[j] * weighted_other[i]);
      }
    }
    squared_residuals_ = squared_residuals_ + q[6] * q[6];
    const Float intensities[2] = {select(is_seen, value, zero), select(is_seen, seen, zero)};
    moments_C_[0] = moments_C_[0] + intensities[0];
    moments_C_[1] = moments_C_[1] + intensities[0] * intensities[0];
    moments_K_[0] = moments_K_[0] + intensities[1];
    moments_K_[1] = moments_K_[1] + intensities[1] * intensities[1];
    pixels_ += count(is_seen);
  }

  const PhotometryInput& in_;
  Float products_[PhotometrySums::kNumProducts];
  Float cross_products_[PhotometrySums::kNumCrossProducts];
  Float squared_residuals_ = Float(0.0F);
  Float moments_C_[2] = {Float(0.0F), Float(0.0F)};
  Float moments_K_[2] = {Float(0.0F), Float(0.0F)};
  std::int32_t pixels_ = 0;
};

template <typename Pack>
PhotometrySums sum_photometry_rows(const PhotometryInput& input, int first_row, int last_row) {
  RowPhotometry<Pack> rows(input);
  for (int v = first_row; v < last_row; ++v) rows.add_row(v);
  return rows.sums();
}

}  // namespace kintsugi::mapper
