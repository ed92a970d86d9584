#include "segmenter/evaluation/quality/quality.hpp"

#include <string>
#include <unordered_map>

#include "lcmtypes/base/argument_check.hpp"

namespace kintsugi::segmenter {
namespace {

double ratio(double sum, std::int64_t count) {
  return count == 0 ? 0.0 : sum / static_cast<double>(count);
}

void score_instances(const std::set<std::uint32_t>& objects, const QualityConfig& config,
                     SegmentationQuality& quality) {
  double instance_sum = 0.0;
  double object_sum = 0.0;
  for (const InstanceScore& score : quality.instances) {
    if (score.num_points < config.min_instance_points) continue;
    ++quality.num_instances;
    instance_sum += score.best_iou;
    if (!objects.contains(score.instance)) continue;
    ++quality.num_objects;
    object_sum += score.best_iou;
    if (score.best_iou >= config.found_iou) ++quality.num_objects_found;
  }
  quality.instance_iou = ratio(instance_sum, quality.num_instances);
  quality.object_iou = ratio(object_sum, quality.num_objects);
}

void count_segments(std::span<const std::uint32_t> segments, const QualityConfig& config,
                    SegmentationQuality& quality) {
  std::unordered_map<std::uint32_t, std::int64_t> sizes;
  for (const std::uint32_t segment : segments) {
    if (segment != kNoSegment) ++sizes[segment];
  }
  std::int64_t num_in_large = 0;
  for (const auto& [segment, size] : sizes) {
    if (size >= config.large_segment_points) num_in_large += size;
  }
  quality.num_segments = std::ssize(sizes);
  quality.large_segment_share = ratio(static_cast<double>(num_in_large), std::ssize(segments));
}

}  // namespace

void QualityConfig::validate() const {
  require(min_instance_points >= 1, "min_instance_points", min_instance_points, ">= 1");
  require(found_iou > 0.0 && found_iou <= 1.0, "found_iou", found_iou, "in (0, 1]");
  require(large_segment_points >= 1, "large_segment_points", large_segment_points, ">= 1");
  boundary.validate();
}

SegmentationQuality assess_quality(std::span<const CloudPoint> points_W,
                                   std::span<const std::uint32_t> instances,
                                   std::span<const std::uint32_t> segments,
                                   const std::set<std::uint32_t>& objects,
                                   const QualityConfig& config) {
  config.validate();
  SegmentationQuality quality;
  OverlapTable table = overlap_table(instances, segments);
  quality.num_points = table.num_points;
  quality.achievable_accuracy = achievable_accuracy(table);
  quality.undersegmentation_error = undersegmentation_error(table);
  quality.boundary = boundary_score(points_W, instances, segments, config.boundary);
  quality.instances = std::move(table.instances);
  score_instances(objects, config, quality);
  count_segments(segments, config, quality);
  return quality;
}

}  // namespace kintsugi::segmenter
