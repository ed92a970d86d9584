#pragma once

#include <array>
#include <cstdint>

#include "lcmtypes/messages.hpp"
#include "segmenter/map/extent.hpp"

namespace kintsugi::segmenter {

/// What the statistics of a segment are made of. The sums are integers in fixed point (units of
/// 2^-40), so that adding and removing points in any order gives the very result of summing from
/// scratch. A coordinate of more than 15 micrometres, a float32, is exact in these units.
struct SegmentSums {
  __extension__ using WideInteger = __int128;  // 2^60 for each coordinate, and room for 2^67 points

  std::int64_t num_points = 0;
  std::array<WideInteger, 3> position{};
  std::array<WideInteger, 3> normal{};
  std::array<std::int64_t, 3> color{};
  Extent extent;

  /// Adds `point`, or takes it out when `sign` is -1; all but the extent.
  void add(const CloudPoint& point, std::int64_t sign);

  /// Of at least one point. `resolution_m`: a point stands for resolution_m^2 of surface.
  [[nodiscard]] SegmentStatistics statistics(std::uint32_t segment_id, float resolution_m) const;
};

}  // namespace kintsugi::segmenter
