#pragma once
// What a segment map knows of one view of the camera.

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/evaluation/live/live_map.hpp"
#include "segmenter/query/place_search.hpp"

namespace kintsugi::segmenter {

/// Everything that the camera measures in a view.
std::vector<MeasuredPoint> measured_points(const CameraView& view);

/// The share of the measured points with a point of a segment at most `radius_m` away; nothing when
/// nothing is measured.
std::optional<double> covered_share(const LiveMap& map, const std::vector<MeasuredPoint>& measured,
                                    double radius_m);

/// A point of a segment.
struct SegmentPoint {
  Eigen::Vector3d point_W = Eigen::Vector3d::Zero();
  std::uint32_t segment_id = kNoSegment;
};

/// What kintsugi-query --pixel answers (measured_surface()).
std::optional<SegmentPoint> answer_pixel(const LiveMap& map, const MeasuredPoint& measured,
                                         double radius_m);
/// What kintsugi-query --ray answers (visible_point()) up to `max_range_m`.
std::optional<SegmentPoint> answer_ray(const LiveMap& map, const Ray& ray, double radius_m,
                                       double max_range_m);

/// The labelled point nearest to `p_W` and at most `radius_m` away.
std::optional<SegmentPoint> nearest_label(const LiveMap& map, const Eigen::Vector3d& p_W,
                                          double radius_m);

}  // namespace kintsugi::segmenter
