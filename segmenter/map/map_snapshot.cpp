#include "segmenter/map/map_snapshot.hpp"

namespace kintsugi::segmenter {

void take_snapshot(const SegmentMap& map, MapSnapshot& snapshot) {
  map.copy_state(snapshot.state);
  snapshot.is_complete = map.is_complete();
  snapshot.segments = map.statistics().all();
}

MapSnapshot take_snapshot(const SegmentMap& map) {
  MapSnapshot snapshot;
  take_snapshot(map, snapshot);
  return snapshot;
}

}  // namespace kintsugi::segmenter
