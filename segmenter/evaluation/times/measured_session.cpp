#include "segmenter/evaluation/times/measured_session.hpp"

#include <algorithm>

#include "lcmtypes/base/argument_check.hpp"
#include "lcmtypes/base/process_memory.hpp"
#include "lcmtypes/base/stopwatch.hpp"
#include "segmenter/core/ids/segment_ids.hpp"
#include "segmenter/core/make_engine.hpp"
#include "segmenter/core/points/point_cloud.hpp"

namespace kintsugi::segmenter {
namespace {

/// Reports how far a measurement is, and estimates the rest from the work that is left.
class ProgressReporter {
 public:
  ProgressReporter(std::string mode, std::size_t num_steps, double total_work,
                   const OnMeasurementProgress& on_progress)
      : on_progress_(on_progress), total_work_(total_work) {
    progress_.mode = std::move(mode);
    progress_.num_steps = static_cast<std::int32_t>(num_steps);
  }

  void report(const MeasuredRun& run, double work) {
    work_ += work;
    progress_.step = run.step + 1;
    progress_.map_points = run.map_points;
    progress_.last_ms = run.engine_ms;
    progress_.rest_s =
        work_ > 0.0 ? 1e-3 * watch_.elapsed_ms() * (total_work_ - work_) / work_ : 0.0;
    if (on_progress_) on_progress_(progress_);
  }

 private:
  const OnMeasurementProgress& on_progress_;
  double total_work_;
  double work_ = 0.0;
  Stopwatch watch_;
  MeasurementProgress progress_;
};

/// First returns to the system what earlier measurements have freed, so that growth is our own.
std::int64_t resident_bytes_at_begin() {
  return_free_memory();
  return process_memory().resident_bytes;
}

double count_points(const SliceGroup& step) {
  double count = 0.0;
  for (const CloudSlice& slice : step.slices) count += static_cast<double>(slice.points_W.size());
  return count;
}

void put_into(PointCloud& cloud, const SliceGroup& step) {
  for (const CloudSlice& slice : step.slices) {
    if (cloud.find_slice(slice.id) == nullptr) {
      cloud.add_slice(slice.id, slice.points_W, slice.revision);
    } else {
      cloud.replace_slice(slice.id, slice.points_W, slice.revision);
    }
  }
}

std::vector<std::uint32_t> labels_by_slice(const PointCloud& cloud,
                                           std::span<const ComponentId> components) {
  std::vector<const SliceRecord*> slices;
  for (const SliceRecord& slice : cloud.slices()) slices.push_back(&slice);
  std::ranges::sort(slices, {}, &SliceRecord::slice_id);
  std::vector<std::uint32_t> names(cloud.size(), kNoComponent);
  std::uint32_t num_names = 0;
  std::vector<std::uint32_t> labels;
  for (const SliceRecord* slice : slices) {
    for (const ComponentId component : components.subspan(slice->first, slice->count)) {
      if (names[component] == kNoComponent) names[component] = num_names++;
      labels.push_back(names[component]);
    }
  }
  return labels;
}

}  // namespace

MeasuredSession measure_incremental(std::span<const SliceGroup> steps, const std::string& mode,
                                    const EngineConfig& config,
                                    const OnMeasurementProgress& on_progress) {
  double num_points = 0.0;
  for (const SliceGroup& step : steps) num_points += count_points(step);

  MeasuredSession measured;
  measured.mode = mode;
  const std::int64_t resident_before = resident_bytes_at_begin();
  PointCloud cloud;
  const auto engine = make_engine(mode, cloud, config);
  SegmentIds ids;
  ProgressReporter reporter(mode, steps.size(), num_points, on_progress);
  for (const SliceGroup& step : steps) {
    MeasuredRun& run = measured.runs.emplace_back();
    run.step = static_cast<std::int32_t>(measured.runs.size()) - 1;
    put_into(cloud, step);

    const CloudChange change = cloud.take_change();
    const double cpu_begin_ms = process_cpu_ms();
    Stopwatch watch;
    run.statistics = engine->update(change);
    run.engine_ms = watch.lap_ms();
    run.engine_cpu_ms = process_cpu_ms() - cpu_begin_ms;
    watch.lap_ms();
    ids.update(cloud, change, engine->components(), engine->changed());
    run.ids_ms = watch.lap_ms();

    run.map_points = cloud.num_live();
    reporter.report(run, count_points(step));
  }
  measured.resident_growth_bytes = process_memory().resident_bytes - resident_before;
  measured.labels = labels_by_slice(cloud, engine->components());
  return measured;
}

MeasuredSession measure_batch(std::span<const SliceGroup> steps, int every,
                              const EngineConfig& config,
                              const OnMeasurementProgress& on_progress) {
  require(every >= 1, "every", every, ">= 1");
  const auto is_due = [&](std::size_t i) {
    return (i + 1) % static_cast<std::size_t>(every) == 0 || i + 1 == steps.size();
  };
  double total_work = 0.0;
  double num_points = 0.0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    num_points += count_points(steps[i]);
    if (is_due(i)) total_work += num_points;
  }

  MeasuredSession measured;
  measured.mode = "batch";
  const std::int64_t resident_before = resident_bytes_at_begin();
  ProgressReporter reporter(measured.mode, steps.size(), total_work, on_progress);
  PointCloud cloud;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    put_into(cloud, steps[i]);
    cloud.take_change();
    if (!is_due(i)) continue;
    MeasuredRun& run = measured.runs.emplace_back();
    run.step = static_cast<std::int32_t>(i);
    run.map_points = cloud.num_live();

    const CloudChange everything = cloud.everything();
    const double cpu_begin_ms = process_cpu_ms();
    const Stopwatch watch;
    const auto engine = make_engine("batch", cloud, config);
    run.statistics = engine->update(everything);
    run.engine_ms = watch.elapsed_ms();
    run.engine_cpu_ms = process_cpu_ms() - cpu_begin_ms;

    reporter.report(run, static_cast<double>(run.map_points));
    if (i + 1 < steps.size()) continue;
    measured.resident_growth_bytes = process_memory().resident_bytes - resident_before;
    measured.labels = labels_by_slice(cloud, engine->components());
  }
  return measured;
}

}  // namespace kintsugi::segmenter
