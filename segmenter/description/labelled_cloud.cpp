#include "segmenter/description/labelled_cloud.hpp"

#include "segmenter/map/map_snapshot.hpp"
#include "segmenter/map/segment_map.hpp"

namespace kintsugi::segmenter {

LabelledCloud labelled_cloud(const SegmentMap& map) {
  const std::span<const std::uint32_t> ids = map.segment_ids().ids();
  const EngineConfig& engine = map.config().engine;
  // Points of an update that failed have no id.
  return {map.cloud().points_W().first(ids.size()), ids, static_cast<float>(engine.resolution_m),
          engine.radius_m()};
}

LabelledCloud labelled_cloud(const MapSnapshot& map) {
  const EngineConfig& engine = map.state.config.engine;
  return {map.state.points_W, map.state.segment_ids, static_cast<float>(engine.resolution_m),
          engine.radius_m()};
}

}  // namespace kintsugi::segmenter
