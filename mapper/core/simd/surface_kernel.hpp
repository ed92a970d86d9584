#pragma once
// The kernels of surface.hpp over any pack: sixteen pixels at a time.

#include <cstddef>

#include "mapper/core/kernels/surface.hpp"
#include "mapper/core/simd/depth_sigma.hpp"
#include "mapper/core/simd/pixel_rows.hpp"
#include "mapper/core/simd/vector_lanes.hpp"

namespace kintsugi::mapper {

template <typename Pack>
class SurfaceRows {
 public:
  static void smooth_depth(const float* padded_m, int width, int v, const DepthTolerance& tolerance,
                           float* smooth_m) {
    constexpr int kReach = kSmoothingReach_px;
    const std::ptrdiff_t pitch = width + 2 * kReach;
    const float* upper_left = padded_m + v * pitch;
    for (int u = 0; u < width; u += Pack::kNumLanes) {
      const int count = lanes_until<Pack>(width - u);
      const Float here = Float::load(upper_left + kReach * pitch + kReach + u, count);
      const Float largest_step = same_surface_m(tolerance, here, kReach);
      Float sum(0.0F);
      Float number(0.0F);
      for (int dv = 0; dv <= 2 * kReach; ++dv) {
        for (int du = 0; du <= 2 * kReach; ++du) {
          const Float depth = Float::load(upper_left + dv * pitch + du + u, count);
          const Mask is_same = abs(depth - here) < largest_step;
          sum = sum + select(is_same, depth, Float(0.0F));
          number = number + select(is_same, Float(1.0F), Float(0.0F));
        }
      }
      select(number > Float(0.0F), sum / number, Float(kNaN))
          .store(smooth_m + u, Mask::first(count));
    }
  }

  static void halve_depth(const float* upper_m, const float* lower_m, float max_depth_m,
                          const DepthTolerance& tolerance, int width, float* half_m) {
    for (int u = 0; u < width; u += Pack::kNumLanes) {
      const int count = lanes_until<Pack>(width - u);
      const int first = 2 * u;
      Four depth = load_four(upper_m + first, lower_m + first, count);
      for (Float& z : depth.of) {
        z = select((z > Float(0.0F)) & (z <= Float(max_depth_m)), z, Float(kInfinity));
      }
      const Nearest nearest(depth, tolerance);
      nearest.mean(depth).store(half_m + u, Mask::first(count));
    }
  }

  static void normals(const float* depth_m, const DepthTolerance& tolerance, int v,
                      const MutableSurfacePlanes& surface) {
    const PinholeCamera& camera = surface.camera;
    const int row = v * camera.width;
    const bool is_border = v == 0 || v + 1 == camera.height;
    for (int u = 0; u < camera.width; u += Pack::kNumLanes) {
      const int count = lanes_until<Pack>(camera.width - u);
      const Vector normal = is_border ? Vector{Float(kNaN), Float(kNaN), Float(kNaN)}
                                      : normal_at(depth_m, tolerance, camera, v, u, count);
      store(normal, surface, row + u, count);
    }
  }

  static void halve_surface(const SurfacePlanes& fine, const DepthTolerance& tolerance, int v,
                            const MutableSurfacePlanes& half) {
    const int width = half.camera.width;
    const int upper = 2 * v * fine.camera.width;
    const int lower = upper + fine.camera.width;
    for (int u = 0; u < width; u += Pack::kNumLanes) {
      const int count = lanes_until<Pack>(width - u);
      const int first = 2 * u;
      const auto load = [&](const float* plane) {
        return load_four(plane + upper + first, plane + lower + first, count);
      };
      Four depth = load(fine.depth_m);
      const Four normal_z = load(fine.normal_z);
      for (int k = 0; k < 4; ++k) {
        const Mask is_valid = (depth.of[k] > Float(0.0F)) & (normal_z.of[k] == normal_z.of[k]);
        depth.of[k] = select(is_valid, depth.of[k], Float(kInfinity));
      }
      const Nearest nearest(depth, tolerance);
      const Vector sum = {nearest.sum(load(fine.normal_x)), nearest.sum(load(fine.normal_y)),
                          nearest.sum(normal_z)};
      const Vector normal = normalized(sum);
      const int pixel = v * width + u;
      const Mask exists = normal.z == normal.z;
      select(exists, nearest.mean(depth), Float(kNaN))
          .store(half.depth_m + pixel, Mask::first(count));
      store(normal, half, pixel, count);
    }
  }

  static std::int32_t count_in_box(const BoxCount& in, int v) {
    const PinholeCamera& camera = in.frame_C.camera;
    const Float y((static_cast<float>(v) - camera.cy) * camera.inverse_fy);
    const int row = v * camera.width;
    std::int32_t result = 0;
    for (int u = 0; u < camera.width; u += Pack::kNumLanes) {
      const Float depth =
          Float::load(in.frame_C.depth_m + row + u, lanes_until<Pack>(camera.width - u));
      const Float x = ray_x<Pack>(camera, u);
      Mask is_inside = depth > Float(0.0F);
      for (int axis = 0; axis < 3; ++axis) {
        const float* R = in.X_WC.R[axis];
        const Float coordinate =
            (Float(R[0]) * x + Float(R[1]) * y + Float(R[2])) * depth + Float(in.X_WC.t[axis]);
        is_inside = is_inside & (coordinate >= Float(in.min_W[axis])) &
                    (coordinate <= Float(in.max_W[axis]));
      }
      result += count(is_inside);
    }
    return result;
  }

 private:
  using Float = typename Pack::Float;
  using Mask = typename Pack::Mask;

  static constexpr float kNaN = __builtin_nanf("");
  static constexpr float kInfinity = __builtin_inff();
  static constexpr float kRoot2 = 1.41421356F;

  using Vector = VectorLanes<Float>;
  /// The pixels of a 2x2 square, for each of sixteen squares side by side.
  struct Four {
    Float of[4];
  };

  /// The largest step in depth between two pixels of the same surface, `steps` pixels apart.
  static Float same_surface_m(const DepthTolerance& tolerance, const Float& depth_m, int steps) {
    return Float(DepthTolerance::kSigmas * kRoot2) * depth_sigma_m(tolerance.variance, depth_m) +
           Float(static_cast<float>(steps) * tolerance.slope) * depth_m;
  }
  static Four load_four(const float* upper, const float* lower, int count) {
    Four result;
    load_pairs(upper, 2 * count, result.of[0], result.of[1]);
    load_pairs(lower, 2 * count, result.of[2], result.of[3]);
    return result;
  }
  /// The even and the odd of `count` numbers, 0 to 32.
  static void load_pairs(const float* numbers, int count, Float& even, Float& odd) {
    constexpr int kHalf = Pack::kNumLanes;
    const Float first = Float::load(numbers, lanes_until<Pack>(count));
    const Float second = count > kHalf ? Float::load(numbers + kHalf, count - kHalf) : Float(0.0F);
    even = even_lanes(first, second);
    odd = odd_lanes(first, second);
  }
  static void store(const Vector& normal, const MutableSurfacePlanes& surface, int pixel,
                    int count) {
    const Mask lanes = Mask::first(count);
    normal.x.store(surface.normal_x + pixel, lanes);
    normal.y.store(surface.normal_y + pixel, lanes);
    normal.z.store(surface.normal_z + pixel, lanes);
  }
  /// NaN where the length is zero or NaN.
  static Vector normalized(const Vector& vector) {
    const Float squared = dot(vector, vector);
    const Float scale = select(squared > Float(0.0F), Float(1.0F) / sqrt(squared), Float(kNaN));
    return {vector.x * scale, vector.y * scale, vector.z * scale};
  }

  /// Which of four depths (infinity: invalid) lie on the same surface as the nearest of them.
  class Nearest {
   public:
    Nearest(const Four& depth, const DepthTolerance& tolerance) {
      const Float nearest = min(min(depth.of[0], depth.of[1]), min(depth.of[2], depth.of[3]));
      const Float largest_step = same_surface_m(tolerance, nearest, 1);
      number_ = Float(0.0F);
      for (int k = 0; k < 4; ++k) {
        is_near_[k] = depth.of[k] - nearest < largest_step;
        number_ = number_ + select(is_near_[k], Float(1.0F), Float(0.0F));
      }
    }
    Float sum(const Four& values) const {
      Float result(0.0F);
      for (int k = 0; k < 4; ++k) {
        result = result + select(is_near_[k], values.of[k], Float(0.0F));
      }
      return result;
    }
    /// NaN where no depth is valid.
    Float mean(const Four& values) const {
      return select(number_ > Float(0.0F), sum(values) / number_, Float(kNaN));
    }

   private:
    Mask is_near_[4];
    Float number_;
  };

  /// The normals of `count` pixels from column `u` on; row `v` is not at the image's border.
  static Vector normal_at(const float* depth_m, const DepthTolerance& tolerance,
                          const PinholeCamera& camera, int v, int u, int count) {
    const float* here = depth_m + static_cast<std::ptrdiff_t>(v) * camera.width + u;
    const auto ray_y = [&](int row) {
      return Float((static_cast<float>(row) - camera.cy) * camera.inverse_fy);
    };
    // In the first and the last column one neighbour is a pixel of another row: no normal there.
    const Float left = Float::load(here - 1, count);
    const Float right = Float::load(here + 1, count);
    const Float above = Float::load(here - camera.width, count);
    const Float below = Float::load(here + camera.width, count);
    const Float x = ray_x<Pack>(camera, u);
    const Float step(camera.inverse_fx);
    const Vector du = {right * (x + step) - left * (x - step), (right - left) * ray_y(v),
                       right - left};
    const Vector dv = {(below - above) * x, below * ray_y(v + 1) - above * ray_y(v - 1),
                       below - above};
    // u points right and v down, so dv x du points towards the camera.
    const Vector normal = normalized(cross(dv, du));
    const Float column = Float(static_cast<float>(u)) + Float::iota();
    const Float center = Float::load(here, count);
    const Float reach = same_surface_m(tolerance, center, 2);
    // A NaN among the neighbours makes these comparisons false.
    const Mask is_surface = (column > Float(0.0F)) &
                            (column < Float(static_cast<float>(camera.width - 1))) &
                            (center > Float(0.0F)) & (abs(du.z) < reach) & (abs(dv.z) < reach);
    const Float nan(kNaN);
    return {select(is_surface, normal.x, nan), select(is_surface, normal.y, nan),
            select(is_surface, normal.z, nan)};
  }
};

}  // namespace kintsugi::mapper
