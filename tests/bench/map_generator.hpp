#pragma once

#include <cstdint>

#include "tests/bench/map_generator_file.hpp"

namespace kintsugi::segmenter::bench {

struct MapConfig {
  std::uint32_t seed = 1;
  std::size_t num_points = 4'000'000;  ///< the walk ends when there are so many, >= 1
  double noise = 1.0;                  ///< times that of a depth camera, >= 0
  int num_rooms = 14;                  ///< >= 1
};

/// A map as a fused one is, without the cost of fusing it: a cube of 1.5 m is carried through
/// furnished rooms along a corridor, and where blocks leave it their surface is a slice (at most
/// 9,000 points). A block holds a noisy signed distance field on a grid of 1 cm; its points are the
/// zero crossings along x, y and z, their normals its gradient. A block that is entered again gives
/// other points: the noise is another, and the map has drifted by millimetres. Floor and ceiling
/// are two giant surfaces.
///
/// The same on every machine, up to its mathematical library. Throws std::invalid_argument naming
/// field, value and bound.
Slices generate_map(const MapConfig& config);

}  // namespace kintsugi::segmenter::bench
