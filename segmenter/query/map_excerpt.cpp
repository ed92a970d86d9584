#include "segmenter/query/map_excerpt.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <span>

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

/// The boxes of the segments, and all that is within r of them: slightly more, because distances
/// are rounded.
std::vector<Eigen::AlignedBox3f> boxes_around(std::span<const SegmentStatistics> segments,
                                              float radius_m) {
  std::vector<Eigen::AlignedBox3f> boxes_W;
  for (const SegmentStatistics& segment : segments) {
    const Eigen::Map<const Eigen::Vector3f> box_min_W(segment.box_min_W);
    const Eigen::Map<const Eigen::Vector3f> box_max_W(segment.box_max_W);
    const Eigen::Vector3f reach_m = Eigen::Vector3f::Constant(1.01F * radius_m);
    boxes_W.emplace_back(Eigen::Vector3f(box_min_W - reach_m),
                         Eigen::Vector3f(box_max_W + reach_m));
  }
  return boxes_W;
}

// Slice after slice, as in a snapshot: sums over points depend on their order.
void take_points(const SegmentMap& map, const LabelledCloud& cloud, MapExcerpt& excerpt) {
  excerpt.points_W.clear();
  excerpt.segment_ids.clear();
  const auto boxes_W = boxes_around(excerpt.segments, cloud.radius_m);
  for (const SliceRecord& slice : map.cloud().slices()) {
    // Points of an update that failed have no id.
    const std::size_t end = std::min<std::size_t>(slice.first + slice.count, cloud.points_W.size());
    for (std::size_t i = boxes_W.empty() ? end : slice.first; i < end; ++i) {
      const CloudPoint& point = cloud.points_W[i];
      const Eigen::Vector3f p_W(point.x, point.y, point.z);
      if (std::ranges::none_of(boxes_W, [&](const auto& box_W) { return box_W.contains(p_W); })) {
        continue;
      }
      excerpt.points_W.push_back(point);
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
    case QueryPlace::kViews:
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
