#pragma once
// Statistics of a segment as JSON: the keys that every program of ours writes them with.

#include <nlohmann/json.hpp>

#include "lcmtypes/base/number_text.hpp"
#include "lcmtypes/messages.hpp"

namespace kintsugi {

/// Three numbers, with as few decimals as mean these floats.
inline nlohmann::ordered_json vector_json(const float (&v)[3]) {
  return {readable(v[0]), readable(v[1]), readable(v[2])};
}

/// Metres and square metres, frame W; keys in the order a person reads them.
inline nlohmann::ordered_json statistics_json(const SegmentStatistics& s) {
  return {{"id", s.segment_id},
          {"points", s.num_points},
          {"box_min", vector_json(s.box_min_W)},
          {"box_max", vector_json(s.box_max_W)},
          {"centroid", vector_json(s.centroid_W)},
          {"mean_normal", vector_json(s.mean_normal_W)},
          {"mean_color", {s.mean_color[0], s.mean_color[1], s.mean_color[2]}},
          {"area", readable(s.area_m2)},
          {"first_slice", s.first_slice},
          {"last_slice", s.last_slice}};
}

}  // namespace kintsugi
