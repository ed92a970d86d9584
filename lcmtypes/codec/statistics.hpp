#pragma once
// Statistics of a segment: the same record in updates and in answers.

#include "lcmtypes/codec/check.hpp"

namespace kintsugi::codec {

static_assert(sizeof(SegmentStatistics) == 72);

inline void check_statistics(const Check& check, const SegmentStatistics& statistics) {
  for (int axis = 0; axis < 3; ++axis) {
    check.finite("statistics box_min_W", statistics.box_min_W[axis]);
    check.finite("statistics box_max_W", statistics.box_max_W[axis]);
    check.finite("statistics centroid_W", statistics.centroid_W[axis]);
    check.finite("statistics mean_normal_W", statistics.mean_normal_W[axis]);
  }
  check.finite("statistics area_m2", statistics.area_m2);
  check.not_negative("statistics first_slice", statistics.first_slice);
  check.not_negative("statistics last_slice", statistics.last_slice);
}

}  // namespace kintsugi::codec
