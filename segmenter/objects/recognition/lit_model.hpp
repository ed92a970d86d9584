#pragma once
// The colours of an object in the light of another place.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "segmenter/objects/recognition/agreement.hpp"

namespace kintsugi::segmenter {

/// Colours are computed when they are first asked for: roots cost more than all else of a
/// comparison.
class LitModel {
 public:
  /// `surface_O` must outlive this.
  LitModel(const Surface& surface_O, const LightChange& light)
      : surface_O_(surface_O),
        gain_(light.log_gain.array().exp()),
        lab_(surface_O.size()),
        is_known_(surface_O.size(), 0) {}

  /// In CIELAB, from a point of the object to one that is seen. Zero where one of them has no
  /// colour.
  [[nodiscard]] Eigen::Vector3f color_difference(std::size_t model_point,
                                                 const SurfacePoint& seen) {
    const SurfacePoint& point = surface_O_[model_point];
    if (!point.has_color || !seen.has_color) return Eigen::Vector3f::Zero();
    if (is_known_[model_point] == 0) {
      lab_[model_point] = lab_of((point.rgb.array() * gain_).min(1.0F));
      is_known_[model_point] = 1;
    }
    return seen.lab - lab_[model_point];
  }

  /// Whether a point of the object and one that is seen may be the same: kSameColor. Points without
  /// colour say nothing about it.
  [[nodiscard]] bool same_color(std::size_t model_point, const SurfacePoint& seen) {
    return is_same_color(color_difference(model_point, seen));
  }

 private:
  const Surface& surface_O_;
  Eigen::Array3f gain_;
  std::vector<Eigen::Vector3f> lab_;
  std::vector<std::uint8_t> is_known_;
};

}  // namespace kintsugi::segmenter
