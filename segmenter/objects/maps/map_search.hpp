#pragma once
// Where one map may lie in another, by the shape of all of it.

#include <cstddef>
#include <span>
#include <vector>

#include "lcmtypes/geometry.hpp"
#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

/// A place of map B in map A, before it is refined.
struct MapHypothesis {
  Pose X_AB = Pose::Identity();
  double score = 0.0;  ///< correlation of the surfaces, 0 to 1
};

/// The best places among all translations and all turns about the vertical, best first; two of them
/// differ by half a metre or 10 degrees at least.
///
/// Turns are those for which the directions of upright surfaces agree, heights those for which
/// level surfaces do; for each of them the translation in the plane is where the surfaces, sorted
/// by height and direction, correlate most: all translations at once, by Fourier transforms. So
/// every surface has its say, and things that have come or gone matter as much as they are large.
///
/// @param samples_A, samples_B surface_samples() of the maps
/// @param up_A, up_B unit vectors
std::vector<MapHypothesis> search_map(std::span<const CloudPoint> samples_A,
                                      const Eigen::Vector3d& up_A,
                                      std::span<const CloudPoint> samples_B,
                                      const Eigen::Vector3d& up_B, std::size_t most);

}  // namespace kintsugi::segmenter
