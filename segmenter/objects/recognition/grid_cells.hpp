#pragma once
// How large the cells of a grid have to be.

#include <Eigen/Core>

namespace kintsugi::segmenter {

/// `cell_m`, or so much more that a grid of this extent has at most `most` cells.
inline float bounded_cell_m(float cell_m, const Eigen::Vector3f& extent_m, double most) {
  const auto num_cells = [&] {
    return ((extent_m.cast<double>() / cell_m).array().floor() + 1.0).prod();
  };
  while (num_cells() > most) cell_m *= 1.26F;  // twice the volume
  return cell_m;
}

}  // namespace kintsugi::segmenter
