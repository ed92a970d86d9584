#pragma once

#include <span>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "tests/fuzz/random.hpp"

namespace kintsugi::segmenter::fuzz {

/// The resolution of the clouds, and of the maps that pieces are cut from.
inline constexpr double kResolution_m = 0.01;

/// About `num_points` points: a piece of `map_W` (mostly, if there is a map), a sheet, a line of
/// points, a clump, or clumps that single points bridge. Weights are as the surface has them, tied
/// (normals and places of few values) or arbitrary over orders of magnitude (each normal tilted on
/// its own). In order along an axis, or shuffled.
std::vector<CloudPoint> random_cloud(Random& random, std::size_t num_points,
                                     std::span<const CloudPoint> map_W);

}  // namespace kintsugi::segmenter::fuzz
