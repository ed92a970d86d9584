#pragma once

#include <cstdint>

#include "tests/bench/map_generator_file.hpp"

namespace kintsugi::segmenter::bench {

struct MapConfig {
  std::uint32_t seed = 1;
  std::size_t num_points = 4'000'000;  ///< the walk ends at this number of points, >= 1
  double noise = 1.0;                  ///< factor on the noise of a depth camera, >= 0
  int num_rooms = 14;                  ///< >= 1
};

/// Generates a map that resembles a fused one without fusing frames: a cube of 1.5 m moves through
/// furnished rooms along a corridor, and the surface of the blocks that leave it makes slices (of
/// at most 9,000 points). A block holds a noisy signed distance field on a grid of 1 cm; its points
/// are the zero crossings along x, y and z, their normals its gradient. A block that enters the
/// cube again gives other points: with other noise, and a drift of some millimetres. Floor and
/// ceiling are two very large surfaces.
///
/// The same on every machine with the same mathematical library. Throws std::invalid_argument
/// naming field, value and bound.
Slices generate_map(const MapConfig& config);

}  // namespace kintsugi::segmenter::bench
