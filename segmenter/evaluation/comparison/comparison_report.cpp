#include "segmenter/evaluation/comparison/comparison_report.hpp"

#include <spdlog/fmt/fmt.h>

#include "segmenter/evaluation/comparison/comparison_plots.hpp"
#include "segmenter/evaluation/comparison/comparison_tables.hpp"
#include "segmenter/evaluation/report/text_file.hpp"

namespace kintsugi::segmenter {
namespace {

Facts map_facts(const Comparison& comparison) {
  const SegmentationQuality& any = comparison.presets.front().quality;
  return {{"Map", comparison.source},
          {"Truth", comparison.truth_source},
          {"Points", grouped(comparison.num_points)},
          {"Points rejected", grouped(comparison.num_rejected)},
          {"Points that have an instance", grouped(any.num_points)},
          {"Instances that count", grouped(any.num_instances)},
          {"Objects among them", grouped(any.num_objects)},
          {"Resolution", decimal(1e3 * comparison.resolution_m, 3) + " mm"}};
}

std::string definitions(const ComparisonConfig& config) {
  return fmt::format(
      "A point has the instance of the nearest point of the truth within {:g} voxels; without one "
      "it "
      "is left out. Best IoU: of an instance, over all segments; instances with {} points of the "
      "map "
      "and more count. Found: best IoU of at least {:g}. ASA: points labelled right when each "
      "segment "
      "gets its best label (Liu et al. 2011). UE: under-segmentation error of Neubert and Protzel "
      "(2012). Boundary: a point with another label within {:g} voxels; right when one of the "
      "other "
      "labelling is within {:g}. Large segments have {} points and more.",
      config.match_distance_vox, config.quality.min_instance_points, config.quality.found_iou,
      config.boundary_radius_vox, config.boundary_tolerance_vox,
      config.quality.large_segment_points);
}

std::string make_page(const Comparison& comparison, const ReportContext& context,
                      const std::vector<DrawnFigure>& figures) {
  std::string body = html_list(map_facts(comparison));
  for (const std::string& remark : comparison.remarks) body += html_remark(remark);
  body += html_section("Presets") + html_wide(readable_quality(comparison.presets)) +
          html_note(definitions(comparison.config));
  if (!comparison.sweep.empty()) {
    body += html_section("One parameter at a time, around objects") +
            html_wide(readable_quality(comparison.sweep));
  }
  body += html_figures(figures);
  body += html_section("Instances") + html_wide(readable_instances(comparison));
  body += html_section("How it was made") + html_list(facts_of(context));
  return html_page("Quality of " + std::filesystem::path(comparison.source).filename().string(),
                   body);
}

}  // namespace

bool write_comparison_report(const Comparison& comparison, const ReportContext& context,
                             const std::filesystem::path& folder) {
  write_text_file(folder / "quality.csv", to_csv(quality_table(comparison)));
  write_text_file(folder / "instances.csv", to_csv(instance_table(comparison)));
  const auto drawn =
      draw_figures(quality_figures(comparison), context.gnuplot_version.has_value(), folder);
  write_text_file(folder / "index.html", make_page(comparison, context, drawn));
  return are_drawn(drawn);
}

}  // namespace kintsugi::segmenter
