#pragma once
// Measures of the quality of a segmentation, given the true instances.

#include <cstdint>
#include <set>
#include <span>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/evaluation/quality/boundaries.hpp"
#include "segmenter/evaluation/quality/overlap.hpp"

namespace kintsugi::segmenter {

struct QualityConfig {
  /// Instances with fewer points in the map are not counted in mean IoU and objects found, because
  /// the camera hardly saw them; >= 1.
  std::int64_t min_instance_points = 100;
  double found_iou = 0.5;                   ///< an object is found at this best IoU, in (0, 1]
  std::int64_t large_segment_points = 100;  ///< segments of so many points are large, >= 1
  BoundaryConfig boundary;

  /// Throws std::invalid_argument naming field, value and bound.
  void validate() const;
};

/// Over the points that have an instance; the last two fields are over all points.
struct SegmentationQuality {
  std::vector<InstanceScore> instances;  ///< all there are, ascending
  std::int64_t num_points = 0;           ///< that have an instance
  std::int64_t num_instances = 0;        ///< that count
  std::int64_t num_objects = 0;          ///< of these
  std::int64_t num_objects_found = 0;
  double object_iou = 0.0;    ///< mean of the best IoU over objects; 0 without any
  double instance_iou = 0.0;  ///< the same over all instances that count
  double achievable_accuracy = 0.0;
  double undersegmentation_error = 0.0;
  BoundaryScore boundary;
  std::int64_t num_segments = 0;
  double large_segment_share = 0.0;  ///< of points, those in large segments
};

/// @param points_W that can be segmented
/// @param instances, segments of each point; kNoInstance and kNoSegment where there is none
/// @param objects those of the instances that are objects; the others are structure
/// @throws std::invalid_argument when sizes differ or the config is invalid
SegmentationQuality assess_quality(std::span<const CloudPoint> points_W,
                                   std::span<const std::uint32_t> instances,
                                   std::span<const std::uint32_t> segments,
                                   const std::set<std::uint32_t>& objects,
                                   const QualityConfig& config);

}  // namespace kintsugi::segmenter
