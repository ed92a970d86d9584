#include "segmenter/map/map_snapshot.hpp"

namespace kintsugi::segmenter {

MapSnapshot take_snapshot(const SegmentMap& map) {
  return {map.state(), map.is_complete(), map.statistics().all()};
}

}  // namespace kintsugi::segmenter
