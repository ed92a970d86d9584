#include "segmenter/tools/evaluate/quality_task.hpp"

#include <CLI/CLI.hpp>

#include "lcmtypes/base/logger.hpp"
#include "segmenter/evaluation/comparison/comparison_report.hpp"

namespace kintsugi::segmenter {

void add_quality_options(CLI::App& app, QualityOptions& options) {
  ComparisonConfig& comparison = options.comparison;
  auto* const truth = app.add_option(
      "--ground-truth", options.truth_file,
      "instead of the paper's tables: score the segments of IN against this PLY file with x y z "
      "instance_id (0: unknown)");
  app.add_option(
         "--presets", comparison.presets,
         "what to score: names of presets; labels: the segment_id of IN; flags: the parameters "
         "given by flags")
      ->needs(truth)
      ->delimiter(',')
      ->allow_extra_args(false)
      ->capture_default_str();
  app.add_flag("--sweep", comparison.sweep,
               "also the preset objects with one parameter at a time changed")
      ->needs(truth);
  app.add_option("--min-instance-points", comparison.quality.min_instance_points,
                 "instances of fewer points of the map are not counted, >= 1")
      ->needs(truth)
      ->capture_default_str();
}

bool report_quality(const RecordedSession& session, const QualityOptions& options,
                    const ReportContext& context, const std::filesystem::path& folder) {
  const Truth truth = read_truth(options.truth_file);
  spdlog::info("{}: {} points, {} instances, {} of them objects", truth.source,
               truth.points_W.size(), truth.instances.size(), truth.objects().size());
  std::size_t num_done = 0;
  const auto log_result = [&](const ComparedResult& result, std::size_t num_results) {
    const SegmentationQuality& quality = result.quality;
    spdlog::info(
        "{} of {}: {}: mean best IoU {:.3f}, {} of {} objects found, ASA {:.3f}, {:.1f} % of "
        "points in large segments",
        ++num_done, num_results, result.variant.name, quality.object_iou, quality.num_objects_found,
        quality.num_objects, quality.achievable_accuracy, 100.0 * quality.large_segment_share);
  };
  return write_comparison_report(compare_parameters(session, truth, options.comparison, log_result),
                                 context, folder);
}

}  // namespace kintsugi::segmenter
