#include "segmenter/evaluation/comparison/comparison_plots.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <set>

namespace kintsugi::segmenter {
namespace {

constexpr std::array<const char*, 6> kColors = {"#c62828", "#1565c0", "#2e7d32",
                                                "#ef6c00", "#6a1b9a", "#00838f"};

std::string color_of(std::size_t i) { return kColors.at(i % kColors.size()); }

Series objects_found(const Comparison& comparison, std::size_t number) {
  const ComparedResult& result = comparison.presets[number];
  std::set<std::uint32_t> objects;
  for (const TruthInstance& instance : comparison.instances) {
    if (instance.is_object) objects.insert(instance.id);
  }
  std::vector<double> ious;
  for (const InstanceScore& score : result.quality.instances) {
    const bool counts = score.num_points >= comparison.config.quality.min_instance_points;
    if (counts && objects.contains(score.instance)) ious.push_back(score.best_iou);
  }
  constexpr int kSteps = 200;
  Series series{.name = result.variant.name, .color = color_of(number), .points = {}};
  for (int step = 0; step <= kSteps; ++step) {
    const double asked = static_cast<double>(step) / kSteps;
    const auto found = std::ranges::count_if(ious, [&](double iou) { return iou >= asked; });
    series.points.emplace_back(asked, static_cast<double>(found));
  }
  return series;
}

Figure found_figure(const Comparison& comparison) {
  Figure figure{"objects_found",
                "Objects found",
                "Objects whose best segment has at least the IoU on the x axis.",
                {.x_label = "best IoU at least", .y_label = "objects"}};
  figure.plot.x_range = {{0.0, 1.0}};
  std::int64_t most = 1;
  for (std::size_t i = 0; i < comparison.presets.size(); ++i) {
    figure.plot.series.push_back(objects_found(comparison, i));
    most = std::max(most, comparison.presets[i].quality.num_objects);
  }
  figure.plot.y_range = {{0.0, 1.05 * static_cast<double>(most)}};
  return figure;
}

using Score = std::function<double(const SegmentationQuality&)>;

Figure sweep_figure(const Comparison& comparison, const std::string& name, const std::string& title,
                    const Score& score) {
  Figure figure{"sweep_" + name,
                title,
                "The preset objects with one parameter changed; the axis is its factor.",
                {.x_label = "parameter, times that of objects", .y_label = title, .log_x = true}};
  const auto base = std::ranges::find(comparison.presets, "objects",
                                      [](const ComparedResult& r) { return r.variant.name; });
  for (const SweptParameter& parameter : swept_parameters()) {
    Series series{.name = parameter.name,
                  .color = color_of(figure.plot.series.size()),
                  .style = Series::Style::kLinesAndPoints,
                  .points = {}};
    for (const ComparedResult& result : comparison.sweep) {
      if (result.variant.parameter != parameter.name) continue;
      series.points.emplace_back(result.variant.factor, score(result.quality));
    }
    if (base != comparison.presets.end()) series.points.emplace_back(1.0, score(base->quality));
    std::ranges::sort(series.points);
    figure.plot.series.push_back(std::move(series));
  }
  return figure;
}

}  // namespace

std::vector<Figure> quality_figures(const Comparison& comparison) {
  using Quality = const SegmentationQuality&;
  std::vector<Figure> figures = {found_figure(comparison)};
  if (comparison.sweep.empty()) return figures;
  figures.push_back(sweep_figure(comparison, "object_iou", "mean best IoU over objects",
                                 [](Quality q) { return q.object_iou; }));
  figures.push_back(sweep_figure(comparison, "achievable_accuracy",
                                 "achievable segmentation accuracy",
                                 [](Quality q) { return q.achievable_accuracy; }));
  figures.push_back(sweep_figure(comparison, "large_segments", "points in large segments (%)",
                                 [](Quality q) { return 100.0 * q.large_segment_share; }));
  return figures;
}

}  // namespace kintsugi::segmenter
