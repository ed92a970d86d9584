#include "segmenter/evaluation/live/view_measures.hpp"

#include <unordered_set>

#include "segmenter/query/measured_point.hpp"

namespace kintsugi::segmenter {
namespace {

LabelledCloud cloud_of(const LiveMap& map, const FoundPoints& found) {
  return {found.points_W, found.segment_ids, map.resolution_m(), 2.0F * map.resolution_m()};
}

std::optional<SegmentPoint> segment_point(const FoundPoints& found, const std::optional<Hit>& hit) {
  if (!hit) return std::nullopt;
  const CloudPoint& p = found.points_W[hit->point];
  return SegmentPoint{{p.x, p.y, p.z}, found.segment_ids[hit->point]};
}

FoundPoints points_near(const LiveMap& map, const Eigen::Vector3d& p_W, double radius_m) {
  FoundPoints found;
  map.grid().visit_near(p_W, radius_m, [&](const PlacedPoint& point) {
    map.take(point, found);
    return true;
  });
  return found;
}

/// The points in the cells that are at most a radius from the ray.
FoundPoints points_along(const LiveMap& map, const Ray& ray, double radius_m, double max_range_m) {
  FoundPoints found;
  std::unordered_set<CellKey, CellKeyHash> seen;
  const double cell_m = map.grid().cell_m();
  const double reach_m = radius_m + 0.5 * cell_m;  // between two steps
  for (double t_m = 0.0; t_m <= max_range_m; t_m += cell_m) {
    const Eigen::Vector3d p_W = ray.origin_W + t_m * ray.direction_W;
    const auto low = [&](int axis) { return cell_of(p_W[axis] - reach_m, cell_m); };
    const auto high = [&](int axis) { return cell_of(p_W[axis] + reach_m, cell_m); };
    for (std::int64_t i = low(0); i <= high(0); ++i) {
      for (std::int64_t j = low(1); j <= high(1); ++j) {
        for (std::int64_t k = low(2); k <= high(2); ++k) {
          const CellKey key = cell_key(i, j, k);
          if (!seen.insert(key).second) continue;
          map.grid().visit_cell(key, [&](const PlacedPoint& point) {
            map.take(point, found);
            return true;
          });
        }
      }
    }
  }
  return found;
}

}  // namespace

std::vector<MeasuredPoint> measured_points(const CameraView& view) {
  std::vector<MeasuredPoint> points;
  points.reserve(view.depth_mm.size());
  for (int j = 0; j < view.depth_height(); ++j) {
    for (int i = 0; i < view.depth_width(); ++i) {
      if (const auto point = measured_sample(view, i, j)) points.push_back(*point);
    }
  }
  return points;
}

std::optional<double> covered_share(const LiveMap& map, const std::vector<MeasuredPoint>& measured,
                                    double radius_m) {
  if (measured.empty()) return std::nullopt;
  std::int64_t num_covered = 0;
  for (const MeasuredPoint& point : measured) {
    num_covered += map.grid().has_point_within(point.point_W(), radius_m) ? 1 : 0;
  }
  return static_cast<double>(num_covered) / static_cast<double>(measured.size());
}

std::optional<SegmentPoint> answer_pixel(const LiveMap& map, const MeasuredPoint& measured,
                                         double radius_m) {
  const FoundPoints found = points_near(map, measured.point_W(), radius_m);
  return segment_point(found, measured_surface(cloud_of(map, found), measured, radius_m));
}

std::optional<SegmentPoint> answer_ray(const LiveMap& map, const Ray& ray, double radius_m,
                                       double max_range_m) {
  const FoundPoints found = points_along(map, ray, radius_m, max_range_m);
  return segment_point(found, visible_point(cloud_of(map, found), ray, radius_m));
}

std::optional<SegmentPoint> nearest_label(const LiveMap& map, const Eigen::Vector3d& p_W,
                                          double radius_m) {
  const FoundPoints found = points_near(map, p_W, radius_m);
  return segment_point(found, nearest_point(cloud_of(map, found), p_W, radius_m));
}

}  // namespace kintsugi::segmenter
