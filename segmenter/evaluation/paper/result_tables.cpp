#include "segmenter/evaluation/paper/result_tables.hpp"

#include <algorithm>
#include <cmath>

namespace kintsugi::segmenter {
namespace {

/// The time of all steps: the exact sum if each was run, else by the trapezoidal rule from (0, 0).
double total_ms(const std::vector<MeasuredRun>& runs) {
  double total = 0.0;
  std::int32_t step_before = -1;
  double ms_before = 0.0;
  for (const MeasuredRun& run : runs) {
    const std::int32_t num_steps = run.step - step_before;
    total += num_steps * ms_before + (run.engine_ms - ms_before) * (num_steps + 1) / 2.0;
    step_before = run.step;
    ms_before = run.engine_ms;
  }
  return total;
}

}  // namespace

double mean_over_runs(const MeasuredSession& measured, double MeasuredRun::*value) {
  double total = 0.0;
  for (const MeasuredRun& run : measured.runs) total += run.*value;
  return total / static_cast<double>(measured.runs.size());
}

SliceTimes slice_times(const MeasuredSession& measured) {
  std::vector<double> times_ms;
  times_ms.reserve(measured.runs.size());
  for (const MeasuredRun& run : measured.runs) times_ms.push_back(run.engine_ms);
  std::sort(times_ms.begin(), times_ms.end());
  const auto rank =
      static_cast<std::size_t>(std::ceil(0.99 * static_cast<double>(times_ms.size())));
  SliceTimes times;
  times.max_ms = times_ms.back();
  times.min_ms = times_ms.front();
  times.p99_ms = times_ms[rank - 1];
  times.total_s = 1e-3 * total_ms(measured.runs);
  times.average_ms = 1e3 * times.total_s / (measured.runs.back().step + 1);
  return times;
}

Table table1(const Evaluation& evaluation) {
  const RecordedSession& session = evaluation.session;
  Table table;
  table.header = {
      "mode",   "vertices",       "slices",         "build_time_s", "length_m",
      "runs",   "max_ms",         "min_ms",         "average_ms",   "total_s",
      "p99_ms", "cpu_average_ms", "ids_average_ms", "segments",     "memory_growth_bytes"};
  for (const ModeResult& mode : evaluation.modes) {
    const MeasuredSession& measured = mode.measured;
    const SliceTimes times = slice_times(measured);
    table.rows.push_back(
        {measured.mode, std::to_string(evaluation.num_vertices), std::to_string(session.num_slices),
         decimal(session.build_time_s, 6), decimal(session.path_length_m, 6),
         std::to_string(measured.runs.size()), decimal(times.max_ms, 3), decimal(times.min_ms, 3),
         decimal(times.average_ms, 3), decimal(times.total_s, 6), decimal(times.p99_ms, 3),
         decimal(mean_over_runs(measured, &MeasuredRun::engine_cpu_ms), 3),
         decimal(mean_over_runs(measured, &MeasuredRun::ids_ms), 3),
         std::to_string(mode.agreements.size()), std::to_string(measured.resident_growth_bytes)});
  }
  return table;
}

Table table2(const Evaluation& evaluation) {
  Table table;
  table.header = {"mode", "max_slices_behind", "average_slices_behind"};
  for (const ModeResult& mode : evaluation.modes) {
    if (mode.slices_behind.empty()) continue;
    const LagSummary lag = summarize_lag(mode.slices_behind);
    table.rows.push_back(
        {mode.measured.mode, std::to_string(lag.max_slices), decimal(lag.mean_slices, 6)});
  }
  return table;
}

Table agreement_table(const Evaluation& evaluation) {
  Table table;
  table.header = {"mode",     "min_points", "segments",       "points",
                  "share_v1", "mean_v",     "point_share_v1", "point_mean_v"};
  for (const ModeResult& mode : evaluation.modes) {
    for (const std::int64_t min_points : {std::int64_t{1}, kLargeSegment}) {
      const AgreementSummary summary = summarize(mode.agreements, min_points);
      table.rows.push_back({mode.measured.mode, std::to_string(min_points),
                            std::to_string(summary.num_segments),
                            std::to_string(summary.num_points), decimal(summary.exact_share, 6),
                            decimal(summary.mean_v, 6), decimal(summary.exact_point_share, 6),
                            decimal(summary.point_mean_v, 6)});
    }
  }
  return table;
}

Table slices_table(const Evaluation& evaluation, const ModeResult& mode) {
  Table table;
  table.header = {"run",    "slice_id",      "corrections",      "ready_us",
                  "points", "map_points",    "engine_ms",        "engine_cpu_ms",
                  "ids_ms", "slices_behind", "points_segmented", "edges",
                  "joins",  "iterations"};
  for (const MeasuredRun& run : mode.measured.runs) {
    const auto index = static_cast<std::size_t>(run.step);
    const SliceGroup& step = evaluation.session.steps[index];
    std::size_t num_points = 0;
    for (const CloudSlice& slice : step.slices) num_points += slice.points_W.size();
    const RunStatistics& statistics = run.statistics;
    table.rows.push_back(
        {std::to_string(run.step), std::to_string(step.slices.front().id),
         std::to_string(step.is_correction ? step.slices.size() : 0),
         evaluation.session.has_times ? std::to_string(ready_us(step)) : "",
         std::to_string(num_points), std::to_string(run.map_points), decimal(run.engine_ms, 3),
         decimal(run.engine_cpu_ms, 3), decimal(run.ids_ms, 3),
         mode.slices_behind.empty() ? "" : std::to_string(mode.slices_behind[index]),
         std::to_string(statistics.num_points), std::to_string(statistics.num_edges),
         std::to_string(statistics.num_joins), std::to_string(statistics.num_iterations)});
  }
  return table;
}

Table theta_table(const Evaluation& evaluation) {
  Table table;
  table.header = {"rank", "join", "theta", "points"};
  for (const ChosenSegment& segment : evaluation.thetas) {
    for (std::size_t n = 0; n < segment.history.theta.size(); ++n) {
      table.rows.push_back({std::to_string(segment.rank), std::to_string(n),
                            decimal(segment.history.theta[n], 9),
                            std::to_string(segment.history.num_points[n])});
    }
  }
  return table;
}

}  // namespace kintsugi::segmenter
