#include "segmenter/evaluation/comparison/comparison_tables.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include <spdlog/fmt/fmt.h>

namespace kintsugi::segmenter {
namespace {

std::string shortest(double value) { return fmt::format("{:g}", value); }

/// Empty for given labels, whose parameters are unknown.
std::string parameter(const ParameterSet& variant, double EngineConfig::*value) {
  return variant.name == kGivenLabels ? "" : shortest(variant.engine.*value);
}

std::vector<std::string> quality_row(const ComparedResult& result) {
  const ParameterSet& variant = result.variant;
  const SegmentationQuality& quality = result.quality;
  std::vector<std::string> row = {variant.name, variant.parameter, shortest(variant.factor)};
  for (const SweptParameter& swept : swept_parameters()) {
    row.push_back(parameter(variant, swept.value));
  }
  row.insert(row.end(),
             {decimal(quality.object_iou, 4), decimal(quality.instance_iou, 4),
              std::to_string(quality.num_objects_found), std::to_string(quality.num_objects),
              std::to_string(quality.num_instances), decimal(quality.achievable_accuracy, 4),
              decimal(quality.undersegmentation_error, 4), decimal(quality.boundary.recall, 4),
              decimal(quality.boundary.precision, 4), decimal(quality.large_segment_share, 4),
              std::to_string(quality.num_segments), std::to_string(quality.num_points),
              decimal(result.segmentation_ms, 1)});
  return row;
}

/// A true instance and its scores.
struct InstanceRow {
  TruthInstance instance;
  std::int64_t num_points = 0;
  std::vector<double> best_ious;  ///< of each preset
};

/// By ascending id.
std::vector<InstanceRow> instance_rows(const Comparison& comparison) {
  std::vector<InstanceRow> rows;
  rows.reserve(comparison.instances.size());
  for (const TruthInstance& instance : comparison.instances) rows.push_back({instance, 0, {}});
  for (const ComparedResult& result : comparison.presets) {
    std::map<std::uint32_t, const InstanceScore*> scores;
    for (const InstanceScore& score : result.quality.instances) scores[score.instance] = &score;
    for (InstanceRow& row : rows) {
      const auto found = scores.find(row.instance.id);
      row.num_points = found == scores.end() ? 0 : found->second->num_points;
      row.best_ious.push_back(found == scores.end() ? 0.0 : found->second->best_iou);
    }
  }
  return rows;
}

std::string kind_of(const TruthInstance& instance) {
  return instance.is_object ? "object" : "structure";
}

}  // namespace

Table quality_table(const Comparison& comparison) {
  Table table;
  table.header = {"name", "parameter", "factor"};
  for (const SweptParameter& swept : swept_parameters()) table.header.push_back(swept.name);
  table.header.insert(
      table.header.end(),
      {"object_iou", "instance_iou", "objects_found", "objects", "instances", "achievable_accuracy",
       "undersegmentation_error", "boundary_recall", "boundary_precision", "large_segment_share",
       "segments", "points", "segmentation_ms"});
  for (const ComparedResult& result : comparison.presets) table.rows.push_back(quality_row(result));
  for (const ComparedResult& result : comparison.sweep) table.rows.push_back(quality_row(result));
  return table;
}

Table instance_table(const Comparison& comparison) {
  Table table;
  table.header = {"instance", "kind", "name", "points"};
  for (const ComparedResult& result : comparison.presets) {
    table.header.push_back(result.variant.name + "_iou");
  }
  for (const InstanceRow& row : instance_rows(comparison)) {
    auto& cells = table.rows.emplace_back();
    cells = {std::to_string(row.instance.id), kind_of(row.instance), row.instance.name,
             std::to_string(row.num_points)};
    for (const double iou : row.best_ious) cells.push_back(decimal(iou, 4));
  }
  return table;
}

Table readable_quality(const std::vector<ComparedResult>& results) {
  Table table;
  table.header = {"",
                  "mean best IoU, objects",
                  "all instances",
                  "objects found",
                  "ASA",
                  "UE",
                  "boundary recall",
                  "precision",
                  "points in large segments",
                  "segments"};
  for (const ComparedResult& result : results) {
    const SegmentationQuality& quality = result.quality;
    table.rows.push_back(
        {result.variant.name, decimal(quality.object_iou, 3), decimal(quality.instance_iou, 3),
         fmt::format("{} of {}", quality.num_objects_found, quality.num_objects),
         decimal(quality.achievable_accuracy, 3), decimal(quality.undersegmentation_error, 3),
         decimal(quality.boundary.recall, 3), decimal(quality.boundary.precision, 3),
         decimal(100.0 * quality.large_segment_share, 1) + " %", grouped(quality.num_segments)});
  }
  return table;
}

Table readable_instances(const Comparison& comparison) {
  auto rows = instance_rows(comparison);
  std::erase_if(rows, [&](const InstanceRow& row) {
    return row.num_points < comparison.config.quality.min_instance_points;
  });
  std::ranges::stable_sort(rows, {}, [](const InstanceRow& row) {
    return std::tuple(row.instance.is_object, -row.num_points);
  });
  Table table;
  table.header = {"instance", "kind", "points"};
  for (const ComparedResult& result : comparison.presets) {
    table.header.push_back("best IoU, " + result.variant.name);
  }
  for (const InstanceRow& row : rows) {
    auto& cells = table.rows.emplace_back();
    cells = {row.instance.name.empty() ? std::to_string(row.instance.id) : row.instance.name,
             kind_of(row.instance), grouped(row.num_points)};
    for (const double iou : row.best_ious) cells.push_back(decimal(iou, 2));
  }
  return table;
}

}  // namespace kintsugi::segmenter
