#pragma once
// A segmented map together with what the camera saw while it was built.

#include <cstdint>
#include <string>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/map/segment_map_state.hpp"
#include "segmenter/views/map_view.hpp"

namespace kintsugi::segmenter {

struct ObservedMap {
  std::string source;            ///< where it was read, for messages
  std::string map_name;          ///< of the mapper
  std::int64_t map_session = 0;  ///< of the mapper
  float resolution_m = 0.0F;     ///< voxel size, > 0
  SegmentMapConfig config;       ///< with which it was segmented
  std::vector<CloudPoint> points_W;
  std::vector<std::uint32_t> segment_ids;  ///< of each point; 0: in no segment
  std::vector<MapView> views;              ///< by ascending time; empty: nothing is known of them
};

}  // namespace kintsugi::segmenter
