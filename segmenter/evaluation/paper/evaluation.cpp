#include "segmenter/evaluation/paper/evaluation.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include "lcmtypes/base/argument_check.hpp"
#include "lcmtypes/base/process_memory.hpp"
#include "segmenter/core/make_engine.hpp"

namespace kintsugi::segmenter {
namespace {

/// The smallest interval between runs of batch that keeps their total time within the budget, if
/// the time of a run is proportional to the number of points.
int affordable_interval(const RecordedSession& session, double final_ms, double budget_s) {
  double points = 0.0;
  double points_of_all_runs = 0.0;
  for (const auto& step : session.steps) {
    for (const CloudSlice& slice : step.slices)
      points += static_cast<double>(slice.points_W.size());
    points_of_all_runs += points;
  }
  const double all_runs_s = 1e-3 * final_ms * points_of_all_runs / points;
  const double interval = std::ceil(all_runs_s / budget_s);
  return static_cast<int>(std::clamp(interval, 1.0, static_cast<double>(session.steps.size())));
}

std::vector<std::int64_t> lag_of(const MeasuredSession& measured, const RecordedSession& session) {
  std::vector<std::int64_t> all_ready_us;
  std::vector<double> run_ms;
  for (const MeasuredRun& run : measured.runs) {
    all_ready_us.push_back(ready_us(session.steps[static_cast<std::size_t>(run.step)]));
    run_ms.push_back(run.engine_ms);
  }
  return slices_behind(all_ready_us, run_ms);
}

/// Labels by the size of their segments, largest first; at equal size the smaller label first.
std::vector<std::uint32_t> labels_by_size(std::span<const std::uint32_t> labels) {
  std::vector<std::int64_t> sizes;
  for (const std::uint32_t label : labels) {
    if (label >= sizes.size()) sizes.resize(std::size_t{label} + 1, 0);
    ++sizes[label];
  }
  std::vector<std::uint32_t> by_size(sizes.size());
  std::iota(by_size.begin(), by_size.end(), 0);
  std::ranges::stable_sort(by_size, std::greater<>(),
                           [&](std::uint32_t label) { return sizes[label]; });
  return by_size;
}

/// The theta histories of the configured segments, as far as they exist.
std::vector<ChosenSegment> choose_thetas(const RecordedSession& session,
                                         const MeasuredSession& batch,
                                         const EvaluationConfig& config) {
  const std::vector<std::uint32_t> by_size = labels_by_size(batch.labels);
  std::vector<ChosenSegment> chosen;
  std::vector<std::uint32_t> labels;
  for (const int rank : config.segments) {
    if (static_cast<std::size_t>(rank) > by_size.size()) continue;
    chosen.emplace_back().rank = rank;
    labels.push_back(by_size[static_cast<std::size_t>(rank) - 1]);
  }
  auto histories = theta_histories(final_cloud(session), batch.labels, labels, config.engine);
  for (std::size_t i = 0; i < chosen.size(); ++i) chosen[i].history = std::move(histories[i]);
  return chosen;
}

}  // namespace

std::vector<std::string> evaluation_modes() {
  std::vector<std::string> modes;
  const auto known = engine_modes();
  for (const std::string_view mode : {"exact", "voting", "batch"}) {
    if (std::find(known.begin(), known.end(), mode) != known.end()) modes.emplace_back(mode);
  }
  return modes;
}

PointCloud final_cloud(const RecordedSession& session) {
  PointCloud cloud;
  for (const CloudSlice* slice : session.newest_slices()) {
    cloud.add_slice(slice->id, slice->points_W);
  }
  return cloud;
}

void EvaluationConfig::validate() const {
  engine.validate();
  const auto known = engine_modes();
  std::string names;
  for (const std::string_view name : known) names.append(names.empty() ? "" : ", ").append(name);
  require(!modes.empty(), "modes is empty, must be at least one of: " + names);
  for (const std::string& mode : modes) {
    const std::string quoted = "'" + mode + "'";
    require(std::find(known.begin(), known.end(), mode) != known.end(),
            std::string("mode is ").append(quoted).append(", must be one of: ").append(names));
    require(std::count(modes.begin(), modes.end(), mode) == 1,
            std::string("mode ").append(quoted).append(" comes twice"));
  }
  require(batch_every >= 0, "batch_every", batch_every, ">= 0 (0: chosen)");
  require(batch_budget_s > 0.0, "batch_budget_s", batch_budget_s, "> 0");
  for (const int rank : segments) {
    require(rank >= 1, "segments has rank " + std::to_string(rank) + ", must be >= 1 (1: largest)");
    require(std::count(segments.begin(), segments.end(), rank) == 1,
            "segments has rank " + std::to_string(rank) + " twice");
  }
}

Evaluation evaluate(RecordedSession session, EvaluationConfig config,
                    const OnMeasurementProgress& on_progress) {
  config.engine.resolution_m = session.resolution_m();
  config.validate();
  Evaluation result;
  const auto num_steps = static_cast<int>(session.steps.size());
  const MeasuredSession reference =
      measure_batch(session.steps, num_steps, config.engine, on_progress);
  result.num_vertices = reference.runs.back().map_points;
  result.batch_final_ms = reference.runs.back().engine_ms;
  result.num_segments = std::int64_t{std::ranges::max(reference.labels)} + 1;
  result.batch_every = config.batch_every > 0 ? config.batch_every
                                              : affordable_interval(session, result.batch_final_ms,
                                                                    config.batch_budget_s);
  for (const std::string& mode : config.modes) {
    ModeResult& of_mode = result.modes.emplace_back();
    of_mode.measured =
        mode == "batch"
            ? measure_batch(session.steps, result.batch_every, config.engine, on_progress)
            : measure_incremental(session.steps, mode, config.engine, on_progress);
    of_mode.is_complete = of_mode.measured.runs.size() == session.steps.size();
    of_mode.agreements = mutual_overlap(of_mode.measured.labels, reference.labels);
    if (session.has_times && of_mode.is_complete) {
      of_mode.slices_behind = lag_of(of_mode.measured, session);
    }
  }
  result.thetas = choose_thetas(session, reference, config);
  result.labels = reference.labels;
  const ProcessMemory memory = process_memory();
  result.resident_bytes = memory.resident_bytes;
  result.peak_resident_bytes = memory.peak_resident_bytes;
  result.config = std::move(config);
  result.session = std::move(session);
  return result;
}

}  // namespace kintsugi::segmenter
