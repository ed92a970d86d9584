#pragma once
// LinearizeRows over any pack: sixteen pixels of the frame at a time.

#include "mapper/core/kernels/linearization.hpp"
#include "mapper/core/simd/depth_sigma.hpp"
#include "mapper/core/simd/pixel_rows.hpp"
#include "mapper/core/simd/vector_lanes.hpp"

namespace kintsugi::mapper {

template <typename Pack>
class RowLinearization {
 public:
  explicit RowLinearization(const LinearizationInput& input) : in_(input) {
    for (Float& product : products_) product = Float(0.0F);
  }

  void add_row(int v) {
    for_pixels_of_row<Pack>(in_.frame_C.camera, v, [this](int pixel, int u, float y, int count) {
      add_pixels(pixel, u, y, count);
    });
  }

  LinearizationSums sums() const {
    LinearizationSums result = counts_;
    for (int k = 0; k < LinearizationSums::kNumProducts; ++k) {
      result.products[k] = reduce_add(products_[k]);
    }
    result.squared_residuals_m2 = reduce_add(squared_residuals_);
    return result;
  }

 private:
  using Float = typename Pack::Float;
  using Int = typename Pack::Int;
  using Mask = typename Pack::Mask;

  using Vector = VectorLanes<Float>;

  /// Adds `count` pixels of a row: `pixel` is the index of the first, `u` its column; their rays
  /// are (x, y, 1).
  void add_pixels(int pixel, int u, float y, int count) {
    const SurfacePlanes& frame = in_.frame_C;
    // False for NaN, and for lanes beyond the row's end, which are zero.
    const Float depth = Float::load(frame.depth_m + pixel, count);
    const Mask is_measured = depth > Float(0.0F);
    if (none(is_measured)) return;
    const Float x = ray_x<Pack>(frame.camera, u);
    const Vector point = moved(in_.X_VC, Vector{depth * x, depth * Float(y), depth});

    const Association model = associate(point, is_measured);
    if (none(model.exists)) return;
    const Float sigma = depth_sigma_m(in_.variance, depth);
    compare_depths(point.z, model, sigma);

    const Vector offset = {model.point.x - point.x, model.point.y - point.y,
                           model.point.z - point.z};
    const Float noise = Float(in_.max_distance_sigmas) * sigma;
    const Mask is_near =
        model.exists & (dot(offset, offset) < Float(in_.max_squared_distance_m2) + noise * noise);
    if (none(is_near)) return;
    const Vector frame_normal =
        rotated(in_.X_VC, Vector{Float::load(frame.normal_x + pixel, count),
                                 Float::load(frame.normal_y + pixel, count),
                                 Float::load(frame.normal_z + pixel, count)});
    const Vector normal = {gather(in_.model_V.normal_x, model.pixel, is_near),
                           gather(in_.model_V.normal_y, model.pixel, is_near),
                           gather(in_.model_V.normal_z, model.pixel, is_near)};
    const Mask is_inlier = is_near & (dot(frame_normal, normal) > Float(in_.min_normal_cosine));
    if (none(is_inlier)) return;
    counts_.inliers += count_of(is_inlier);
    add_products(point, normal, dot(normal, offset), sigma, is_inlier);
  }

  /// The model pixels onto which points in V project.
  struct Association {
    Mask exists;
    Int pixel;
    Vector point;
  };
  Association associate(const Vector& point, const Mask& is_measured) const {
    const PinholeCamera& camera = in_.model_V.camera;
    const Float zero(0.0F);
    const Float half(0.5F);  // rounding to the nearest pixel becomes truncation
    const Float inverse_z = Float(1.0F) / point.z;
    const Float u = point.x * inverse_z * Float(camera.fx) + Float(camera.cx) + half;
    const Float v = point.y * inverse_z * Float(camera.fy) + Float(camera.cy) + half;
    const Mask is_in_view = is_measured & (point.z > zero) &
                            ((u >= zero) & (u < Float(static_cast<float>(camera.width)))) &
                            ((v >= zero) & (v < Float(static_cast<float>(camera.height))));
    const Int column = to_int(u);
    const Int row = to_int(v);
    Association model;
    model.pixel = row * Int(camera.width) + column;
    model.point.z = gather(in_.model_V.depth_m, model.pixel, is_in_view);
    model.exists = is_in_view & (model.point.z > zero);
    model.point.x =
        model.point.z * ((to_float(column) - Float(camera.cx)) * Float(camera.inverse_fx));
    model.point.y = model.point.z * ((to_float(row) - Float(camera.cy)) * Float(camera.inverse_fy));
    return model;
  }

  void compare_depths(const Float& z, const Association& model, const Float& sigma) {
    const Float tolerance =
        max(Float(in_.agreement_sigmas) * sigma, Float(in_.agreement_distance_m));
    counts_.overlap += count_of(model.exists);
    counts_.behind += count_of(model.exists & (z > model.point.z + tolerance));
    counts_.in_front += count_of(model.exists & (z < model.point.z - tolerance));
  }

  /// d(se3_retract(xi) p)/dxi = [I, -[p]x], so the prediction n . p changes by n for the
  /// translation and by p x n for the rotation. Residuals are limited in b alone.
  void add_products(const Vector& point, const Vector& normal, const Float& residual,
                    const Float& sigma, const Mask& is_inlier) {
    const Float zero(0.0F);
    const Float inverse_sigma = Float(1.0F) / sigma;
    const Vector moment = cross(point, normal);
    const Float row[6] = {normal.x, normal.y, normal.z, moment.x, moment.y, moment.z};
    const Float residual_sigmas = select(is_inlier, residual * inverse_sigma, zero);
    Float weighted[7];
    for (int i = 0; i < 6; ++i) weighted[i] = select(is_inlier, row[i] * inverse_sigma, zero);
    weighted[6] = influence_of(residual_sigmas);
    int k = 0;
// Not unrolled by the compiler on its own, which costs a fifth of the time of this kernel.
#pragma GCC unroll 6
    for (int i = 0; i < 6; ++i) {
#pragma GCC unroll 7
      for (int j = i; j < 7; ++j, ++k) products_[k] = products_[k] + weighted[i] * weighted[j];
    }
    products_[k] = products_[k] + residual_sigmas * residual_sigmas;
    const Float inlier_residual = select(is_inlier, residual, zero);
    squared_residuals_ = squared_residuals_ + inlier_residual * inlier_residual;
  }

  Float influence_of(const Float& residual_sigmas) const {
    const Float zero(0.0F);
    const Float amount = max(residual_sigmas, zero - residual_sigmas);
    const Float falling = max(Float(in_.no_influence_sigmas) - amount, zero);
    const Float limited = min(amount, Float(in_.influence_slope) * falling);
    return select(residual_sigmas < zero, zero - limited, limited);
  }

  static std::int32_t count_of(const Mask& mask) { return count(mask); }

  const LinearizationInput& in_;
  Float products_[LinearizationSums::kNumProducts];
  Float squared_residuals_ = Float(0.0F);
  LinearizationSums counts_;  ///< only the counts are used until sums() is called
};

template <typename Pack>
LinearizationSums linearize_rows(const LinearizationInput& input, int first_row, int last_row) {
  RowLinearization<Pack> rows(input);
  for (int v = first_row; v < last_row; ++v) rows.add_row(v);
  return rows.sums();
}

}  // namespace kintsugi::mapper
