#pragma once
// The development of the join threshold of a segment (Fig. 2 of the paper).

#include <cstdint>
#include <span>
#include <vector>

#include "segmenter/core/engine/engine.hpp"
#include "segmenter/core/parameters/engine_config.hpp"

namespace kintsugi::segmenter {

/// How the join threshold theta of one segment developed while batch joined it (Fig. 2).
///
/// A segment is the result of a tree of joins. Its history is the path in it that follows the
/// larger of both pieces back from the end (of equal ones the one that was there first):
/// `theta[n]` and `num_points[n]` are those of the segment after the n-th join on the path.
struct ThetaHistory {
  std::uint32_t label = 0;               ///< of the segment
  std::vector<double> theta;             ///< T first, of the single point it began with
  std::vector<std::int64_t> num_points;  ///< as long as theta
};

/// The histories of the segments called `segments` in `labels`, the partition of `cloud` by batch,
/// in the order of `segments`. Joins inside a segment do not depend on other segments, so only its
/// own edges are taken once more.
std::vector<ThetaHistory> theta_histories(const PointCloud& cloud,
                                          std::span<const std::uint32_t> labels,
                                          std::span<const std::uint32_t> segments,
                                          const EngineConfig& config);

}  // namespace kintsugi::segmenter
