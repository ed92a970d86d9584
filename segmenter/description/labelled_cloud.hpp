#pragma once

#include <cstdint>
#include <span>

#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

class SegmentMap;
struct MapSnapshot;

/// Points with segment ids, as spans into a live map, a saved map or a labelled file. Valid as long
/// as their source exists and does not change.
struct LabelledCloud {
  std::span<const CloudPoint> points_W;
  std::span<const std::uint32_t> segment_ids;  ///< by point; kNoSegment: the point is ignored
  float resolution_m = 0.0F;                   ///< voxel size, > 0
  float radius_m = 0.0F;                       ///< r: points closer than this are neighbours, > 0
};

LabelledCloud labelled_cloud(const SegmentMap& map);
LabelledCloud labelled_cloud(const MapSnapshot& map);

}  // namespace kintsugi::segmenter
