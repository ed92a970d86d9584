#include "segmenter/map/map_snapshot.hpp"

#include <algorithm>

namespace kintsugi::segmenter {

MapSnapshot take_snapshot(const SegmentMap& map) {
  const PointCloud& cloud = map.cloud();
  MapSnapshot snapshot;
  snapshot.config = map.config();
  snapshot.map_name = map.map_name();
  snapshot.map_session = map.map_session();
  snapshot.session = map.session();
  snapshot.is_complete = map.is_complete();
  snapshot.slices.assign(cloud.slices().begin(), cloud.slices().end());
  snapshot.segments = map.statistics().all();
  snapshot.num_points_rejected = cloud.num_rejected();

  const auto points_W = cloud.points_W();
  const auto ids = map.segment_ids().ids();
  snapshot.points_W.reserve(cloud.num_live());
  snapshot.segment_ids.reserve(cloud.num_live());
  for (const SliceRecord& slice : cloud.slices()) {
    const auto points = points_W.subspan(slice.first, slice.count);
    snapshot.points_W.insert(snapshot.points_W.end(), points.begin(), points.end());
    const auto of_slice = ids.subspan(std::min<std::size_t>(slice.first, ids.size()));
    const auto with_id = of_slice.first(std::min<std::size_t>(slice.count, of_slice.size()));
    snapshot.segment_ids.insert(snapshot.segment_ids.end(), with_id.begin(), with_id.end());
    snapshot.segment_ids.resize(snapshot.points_W.size(), kNoSegment);
  }
  return snapshot;
}

}  // namespace kintsugi::segmenter
