#include "segmenter/query/map_excerpt.hpp"

#include <algorithm>

#include "segmenter/description/adjacency_graph.hpp"
#include "segmenter/map/segment_map.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr std::size_t kFewIds = 8;

void take_identity(const SegmentMap& map, MapExcerpt& excerpt) {
  excerpt.session = map.session();
  excerpt.map_session = map.map_session();
  excerpt.map_name = map.map_name();
  excerpt.map_slices = static_cast<std::int32_t>(map.cloud().slices().size());
  excerpt.map_points = map.cloud().num_live();
  excerpt.map_segments = map.segment_ids().num_segments();
}

void take_segments(const SegmentMap& map, MapExcerpt& excerpt) {
  std::vector<std::uint32_t> ids = excerpt.found.ids;
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  excerpt.segments.clear();
  excerpt.last_changes.clear();
  for (const std::uint32_t id : ids) {
    if (map.segment_ids().num_points_of(id) == 0) continue;
    excerpt.segments.push_back(map.statistics()(id));
    excerpt.last_changes.push_back(map.statistics().last_change(id));
  }
}

// Slice after slice, as in a snapshot: sums over points depend on their order.
void take_points(const SegmentMap& map, const LabelledCloud& cloud, MapExcerpt& excerpt) {
  excerpt.points_W.clear();
  excerpt.segment_ids.clear();
  if (excerpt.segments.empty()) return;
  const auto is_needed = [&](const CloudPoint& point) {
    return std::ranges::any_of(excerpt.segments, [&](const SegmentStatistics& segment) {
      return is_near(point, segment, cloud.radius_m);
    });
  };
  for (const SliceRecord& slice : map.cloud().slices()) {
    for (PointIndex i = slice.first; i < slice.first + slice.count; ++i) {
      if (i >= cloud.segment_ids.size() || !is_needed(cloud.points_W[i])) continue;
      excerpt.points_W.push_back(cloud.points_W[i]);
      excerpt.segment_ids.push_back(cloud.segment_ids[i]);
    }
  }
}

}  // namespace

bool needs_excerpt(const SegmentQuery& query) {
  switch (query.place) {
    case QueryPlace::kPoint:
    case QueryPlace::kRay:
    case QueryPlace::kPixel:
      return true;
    case QueryPlace::kIds:
      return query.segment_ids.size() <= kFewIds;
    default:
      return false;
  }
}

void take_excerpt(const SegmentMap& map, const SegmentQuery& query, const CameraView* view,
                  MapExcerpt& excerpt) {
  const LabelledCloud cloud = labelled_cloud(map);
  excerpt.resolution_m = cloud.resolution_m;
  excerpt.radius_m = cloud.radius_m;
  take_identity(map, excerpt);
  excerpt.found = find_segments(cloud, query, view);
  take_segments(map, excerpt);
  take_points(map, cloud, excerpt);
}

}  // namespace kintsugi::segmenter
