#pragma once
// The nearest point of a surface, looked up in a grid.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "segmenter/objects/recognition/surface.hpp"

namespace kintsugi::segmenter {

/// For each cell of a grid around a surface the surface point that is nearest to its middle. A
/// look-up takes one access, so that thousands of poses of an object can be compared with what is
/// seen.
class SurfaceField {
 public:
  /// @param cell_m side of a cell, > 0; it is enlarged where the grid would have more than
  ///   kMaxCells cells
  /// @param reach_m up to this far from the surface there are answers, > 0
  SurfaceField(const Surface& surface, float cell_m, float reach_m);

  /// The index of the surface point nearest to the middle of the cell of `p`; -1: none is near.
  [[nodiscard]] std::int32_t nearest(const Eigen::Vector3f& p) const {
    const Eigen::Vector3f cell = (p - origin_) * inverse_cell_;
    // Written so that NaN is outside.
    if (!(cell.minCoeff() >= 0.0F && cell.x() < static_cast<float>(size_.x()) &&
          cell.y() < static_cast<float>(size_.y()) && cell.z() < static_cast<float>(size_.z()))) {
      return -1;
    }
    return nearest_[index(cell.cast<std::int32_t>())];
  }

  [[nodiscard]] std::size_t bytes() const { return nearest_.capacity() * sizeof(std::int32_t); }

  static constexpr std::int64_t kMaxCells = 4'000'000;  ///< 16 MB

 private:
  [[nodiscard]] std::size_t index(const Eigen::Vector3i& cell) const {
    return (static_cast<std::size_t>(cell.z()) * size_.y() + cell.y()) * size_.x() + cell.x();
  }

  Eigen::Vector3f origin_ = Eigen::Vector3f::Zero();
  float inverse_cell_ = 1.0F;
  Eigen::Vector3i size_ = Eigen::Vector3i::Zero();
  std::vector<std::int32_t> nearest_;
};

}  // namespace kintsugi::segmenter
