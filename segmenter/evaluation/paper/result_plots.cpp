#include "segmenter/evaluation/paper/result_plots.hpp"

#include <algorithm>
#include <array>

#include "segmenter/evaluation/paper/result_tables.hpp"
#include "segmenter/evaluation/report/table.hpp"

namespace kintsugi::segmenter {
namespace {

using Points = std::vector<std::pair<double, double>>;

constexpr std::size_t kNumBuckets = 1000;  // of a curve: about a pixel each
constexpr char kIntervalColor[] = "#c4c4c4";
constexpr std::array<const char*, 6> kSegmentColors = {"#c62828", "#1565c0", "#2e7d32",
                                                       "#ef6c00", "#6a1b9a", "#00838f"};

/// The paper draws batch blue and its own method red.
std::string color_of(const std::string& mode) {
  if (mode == "batch") return "#1565c0";
  if (mode == "voting") return "#c62828";
  return "#2e7d32";
}

bool is_incremental(const ModeResult& mode) { return mode.measured.mode != "batch"; }

Series times_of(const ModeResult& mode) {
  Series series{.name = mode.measured.mode, .color = color_of(mode.measured.mode), .points = {}};
  for (const MeasuredRun& run : mode.measured.runs) {
    series.points.emplace_back(run.step, run.engine_ms);
  }
  return series;
}

Series time_between_slices(const RecordedSession& session) {
  Series series{.name = "time between slices", .color = kIntervalColor, .points = {}};
  for (std::size_t i = 1; i < session.steps.size(); ++i) {
    const auto interval_us = ready_us(session.steps[i]) - ready_us(session.steps[i - 1]);
    series.points.emplace_back(i, 1e-3 * static_cast<double>(interval_us));
  }
  return series;
}

std::pair<double, double> slice_range(const Evaluation& evaluation) {
  return {0.0, std::max(1.0, static_cast<double>(evaluation.session.steps.size()) - 1.0)};
}

Plot time_plot(const Evaluation& evaluation, bool with_batch) {
  Plot plot{.x_label = "slice", .y_label = "time (ms)"};
  plot.x_range = slice_range(evaluation);
  if (evaluation.session.has_times) {
    plot.series.push_back(time_between_slices(evaluation.session));
  }
  for (const ModeResult& mode : evaluation.modes) {
    if (with_batch || is_incremental(mode)) plot.series.push_back(times_of(mode));
  }
  return plot;
}

double slowest_incremental_ms(const Evaluation& evaluation) {
  double slowest_ms = 0.0;
  for (const ModeResult& mode : evaluation.modes) {
    if (is_incremental(mode)) {
      slowest_ms = std::max(slowest_ms, slice_times(mode.measured).max_ms);
    }
  }
  return slowest_ms;
}

void add_time_figures(const Evaluation& evaluation, std::vector<Figure>& figures) {
  figures.push_back({"fig5a", "Fig. 5 a: time per slice",
                     evaluation.session.has_times
                         ? "Grey: the time between slices; a mode that stays below it keeps up."
                         : "",
                     time_plot(evaluation, true)});
  const double slowest_ms = slowest_incremental_ms(evaluation);
  if (slowest_ms > 0.0) {
    Figure close_up{"fig5b", "Fig. 5 b: time per slice, close up",
                    "The incremental modes; the grey line may leave the figure.",
                    time_plot(evaluation, false)};
    close_up.plot.y_range = {{0.0, 1.1 * slowest_ms}};
    figures.push_back(std::move(close_up));
  }
  Figure logarithmic{"fig5_log", "Time per slice, logarithmic", "The curves of Fig. 5 a.",
                     time_plot(evaluation, true)};
  logarithmic.plot.log_y = true;
  figures.push_back(std::move(logarithmic));
}

void add_lag_figure(const Evaluation& evaluation, std::vector<Figure>& figures) {
  double most = 1.0;
  Figure figure{"lag",
                "Slices behind",
                "Earlier slices not yet segmented when a slice is ready.",
                {.x_label = "slice", .y_label = "slices behind"}};
  for (const ModeResult& mode : evaluation.modes) {
    if (mode.slices_behind.empty()) continue;
    Series series{.name = mode.measured.mode,
                  .color = color_of(mode.measured.mode),
                  .style = Series::Style::kSteps,
                  .points = {}};
    for (std::size_t i = 0; i < mode.slices_behind.size(); ++i) {
      const auto count = static_cast<double>(mode.slices_behind[i]);
      series.points.emplace_back(i, count);
      most = std::max(most, count);
    }
    figure.plot.series.push_back(std::move(series));
  }
  figure.plot.x_range = slice_range(evaluation);
  figure.plot.y_range = {{0.0, 1.05 * most}};
  if (!figure.plot.series.empty()) figures.push_back(std::move(figure));
}

void add_agreement_figure(const Evaluation& evaluation, std::vector<Figure>& figures) {
  Figure figure{"fig4",
                "Fig. 4: agreement with batch",
                "The percentage of segments whose v is at least the value on the x axis.",
                {.x_label = "v (Eq. 5)", .y_label = "segments with at least this v (%)"}};
  figure.plot.x_range = {{0.0, 1.0}};
  figure.plot.y_range = {{0.0, 102.0}};
  for (const ModeResult& mode : evaluation.modes) {
    if (!is_incremental(mode)) continue;
    for (const std::int64_t min_points : {std::int64_t{1}, kLargeSegment}) {
      Points points = cumulative_v(mode.agreements, min_points);
      if (points.empty()) continue;
      const bool all = min_points == 1;
      figure.plot.series.push_back(
          {.name =
               mode.measured.mode + (all ? "" : ", >= " + std::to_string(min_points) + " points"),
           .color = color_of(mode.measured.mode),
           .dashed = !all,
           .points = std::move(points)});
    }
  }
  if (!figure.plot.series.empty()) figures.push_back(std::move(figure));
}

void add_theta_figure(const Evaluation& evaluation, std::vector<Figure>& figures) {
  Figure figure{"fig2",
                "Fig. 2: join threshold against joins",
                "Each segment followed back from its end through the larger of the two pieces of "
                "each join.",
                {.x_label = "join of the segment", .y_label = "join threshold theta"}};
  figure.plot.log_y = true;
  for (const ChosenSegment& segment : evaluation.thetas) {
    const ThetaHistory& history = segment.history;
    Points points;
    for (std::size_t n = 0; n < history.theta.size(); ++n) {
      points.emplace_back(n, history.theta[n]);
    }
    figure.plot.series.push_back(
        {.name = "no. " + std::to_string(segment.rank) + ", " + grouped(history.num_points.back()) +
                 " points",
         .color = kSegmentColors[figure.plot.series.size() % kSegmentColors.size()],
         .points = thinned(points, kNumBuckets)});
  }
  if (!figure.plot.series.empty()) figures.push_back(std::move(figure));
}

}  // namespace

std::vector<std::pair<double, double>> cumulative_v(const std::vector<SegmentAgreement>& agreements,
                                                    std::int64_t min_points, int steps) {
  std::vector<double> values;
  for (const SegmentAgreement& segment : agreements) {
    if (segment.num_points >= min_points) values.push_back(segment.v);
  }
  std::sort(values.begin(), values.end());
  Points points;
  for (int step = 0; step <= steps && !values.empty(); ++step) {
    const double v = static_cast<double>(step) / steps;
    const auto count = values.end() - std::lower_bound(values.begin(), values.end(), v);
    points.emplace_back(v, 100.0 * static_cast<double>(count) / static_cast<double>(values.size()));
  }
  return points;
}

std::vector<Figure> figures(const Evaluation& evaluation) {
  std::vector<Figure> all;
  add_time_figures(evaluation, all);
  add_lag_figure(evaluation, all);
  add_agreement_figure(evaluation, all);
  add_theta_figure(evaluation, all);
  return all;
}

}  // namespace kintsugi::segmenter
