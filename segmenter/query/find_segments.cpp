#include "segmenter/query/find_segments.hpp"

#include <optional>

#include "segmenter/query/measured_point.hpp"
#include "segmenter/query/place_search.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr double kDefaultRadius_vox = 2.0;

Eigen::Vector3d vector(const double (&v)[3]) { return {v[0], v[1], v[2]}; }

double radius_m(const LabelledCloud& cloud, const SegmentQuery& query) {
  if (query.radius_m > 0.0) return query.radius_m;
  return query.place == QueryPlace::kPixel ? pixel_radius_m(cloud.resolution_m)
                                           : kDefaultRadius_vox * cloud.resolution_m;
}

/// What the camera measures at the pixel of the query is entered into `found`.
std::optional<Hit> find_at_pixel(const LabelledCloud& cloud, const SegmentQuery& query,
                                 const CameraView* view, FoundSegments& found) {
  if (view == nullptr) return std::nullopt;
  found.view_utime = view->utime;
  const auto measured = measured_point(*view, query.pixel_px[0], query.pixel_px[1]);
  if (!measured) return std::nullopt;
  found.surface_distance_m = static_cast<float>(measured->distance_m);
  return measured_surface(cloud, *measured, radius_m(cloud, query));
}

std::optional<Hit> find_hit(const LabelledCloud& cloud, const SegmentQuery& query,
                            const CameraView* view, FoundSegments& found) {
  switch (query.place) {
    case QueryPlace::kPoint:
      return nearest_point(cloud, vector(query.point_W), radius_m(cloud, query));
    case QueryPlace::kRay:
      return visible_point(cloud, {vector(query.point_W), vector(query.direction_W)},
                           radius_m(cloud, query));
    case QueryPlace::kPixel:
      return find_at_pixel(cloud, query, view, found);
    default:
      return std::nullopt;
  }
}

}  // namespace

FoundSegments find_segments(const LabelledCloud& cloud, const SegmentQuery& query,
                            const CameraView* view) {
  FoundSegments found;
  if (query.place == QueryPlace::kIds) {
    found.ids = query.segment_ids;
  } else if (query.place == QueryPlace::kBox) {
    found.ids = segments_in_box(cloud, {vector(query.box_min_W), vector(query.box_max_W)});
  } else if (const auto hit = find_hit(cloud, query, view, found)) {
    const CloudPoint& point = cloud.points_W[hit->point];
    found.has_hit = true;
    found.hit_W[0] = point.x;
    found.hit_W[1] = point.y;
    found.hit_W[2] = point.z;
    found.distance_m = static_cast<float>(hit->distance_m);
    found.ids = {cloud.segment_ids[hit->point]};
  }
  return found;
}

}  // namespace kintsugi::segmenter
