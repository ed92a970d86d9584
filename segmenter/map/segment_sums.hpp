#pragma once

#include <array>
#include <cstdint>

#include "lcmtypes/messages.hpp"
#include "segmenter/map/extent.hpp"

namespace kintsugi::segmenter {

/// The sums from which the statistics of a segment are computed. They are integers in fixed point
/// (units of 2^-40), so that adding and removing points in any order gives exactly the result of
/// summing from scratch. Float32 coordinates above 15 micrometres are exact in these units.
struct SegmentSums {
  __extension__ using WideInteger = __int128;  // 2^60 for each coordinate, and room for 2^67 points

  std::int64_t num_points = 0;
  std::int64_t num_in_volume = 0;  ///< of them, points of patches that may still change
  std::array<WideInteger, 3> position{};
  std::array<WideInteger, 3> normal{};
  std::array<std::int64_t, 3> color{};
  Extent extent;

  /// Adds `point`, or subtracts it when `sign` is -1. The extent stays as it is.
  void add(const CloudPoint& point, bool is_in_volume, std::int64_t sign);

  /// Adds the points of `other`.
  void add(const SegmentSums& other);

  /// The statistics of at least one point, each of which stands for resolution_m^2 of surface.
  [[nodiscard]] SegmentStatistics statistics(std::uint32_t segment_id, float resolution_m) const;
};

}  // namespace kintsugi::segmenter
