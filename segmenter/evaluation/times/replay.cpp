#include "segmenter/evaluation/times/replay.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <stdexcept>

#include <malloc.h>

#include "lcmtypes/base/process_memory.hpp"
#include "segmenter/core/ids/segment_ids.hpp"
#include "segmenter/core/make_engine.hpp"
#include "segmenter/core/points/point_cloud.hpp"

namespace kintsugi::segmenter {
namespace {

/// Wall and processor time since it was made.
class Stopwatch {
 public:
  [[nodiscard]] double wall_ms() const {
    return std::chrono::duration<double, std::milli>(Clock::now() - wall_).count();
  }
  [[nodiscard]] double cpu_ms() const {
    return 1e3 * static_cast<double>(std::clock() - cpu_) / CLOCKS_PER_SEC;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point wall_ = Clock::now();
  std::clock_t cpu_ = std::clock();
};

/// Tells how far a replay is, and guesses the rest from the work that is left.
class ProgressTeller {
 public:
  ProgressTeller(std::string mode, std::size_t num_steps, double total_work,
                 const OnReplayProgress& on_progress)
      : on_progress_(on_progress), total_work_(total_work) {
    progress_.mode = std::move(mode);
    progress_.num_steps = static_cast<std::int32_t>(num_steps);
  }

  void tell(const MeasuredRun& run, double work) {
    work_ += work;
    progress_.step = run.step + 1;
    progress_.map_points = run.map_points;
    progress_.last_ms = run.engine_ms;
    progress_.rest_s = work_ > 0.0 ? 1e-3 * watch_.wall_ms() * (total_work_ - work_) / work_ : 0.0;
    if (on_progress_) on_progress_(progress_);
  }

 private:
  const OnReplayProgress& on_progress_;
  double total_work_;
  double work_ = 0.0;
  Stopwatch watch_;
  ReplayProgress progress_;
};

/// Memory that earlier replays have freed goes back first, so that growth is the replay's own.
std::int64_t resident_bytes_at_begin() {
  malloc_trim(0);
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

Replay replay_incrementally(std::span<const SliceGroup> steps, const std::string& mode,
                            const EngineConfig& config, const OnReplayProgress& on_progress) {
  double num_points = 0.0;
  for (const SliceGroup& step : steps) num_points += count_points(step);

  Replay replay;
  replay.mode = mode;
  const std::int64_t resident_before = resident_bytes_at_begin();
  PointCloud cloud;
  const auto engine = make_engine(mode, cloud, config);
  SegmentIds ids;
  ProgressTeller teller(mode, steps.size(), num_points, on_progress);
  for (const SliceGroup& step : steps) {
    MeasuredRun& run = replay.runs.emplace_back();
    run.step = static_cast<std::int32_t>(replay.runs.size()) - 1;
    put_into(cloud, step);

    const CloudChange change = cloud.take_change();
    const Stopwatch engine_watch;
    run.statistics = engine->update(change);
    run.engine_ms = engine_watch.wall_ms();
    run.engine_cpu_ms = engine_watch.cpu_ms();
    const Stopwatch ids_watch;
    ids.update(cloud, change, engine->components(), engine->changed());
    run.ids_ms = ids_watch.wall_ms();

    run.map_points = cloud.num_live();
    teller.tell(run, count_points(step));
  }
  replay.resident_growth_bytes = process_memory().resident_bytes - resident_before;
  replay.labels = labels_by_slice(cloud, engine->components());
  return replay;
}

Replay replay_batch(std::span<const SliceGroup> steps, int every, const EngineConfig& config,
                    const OnReplayProgress& on_progress) {
  if (every < 1) {
    throw std::invalid_argument("every is " + std::to_string(every) + ", must be >= 1");
  }
  const auto is_due = [&](std::size_t i) {
    return (i + 1) % static_cast<std::size_t>(every) == 0 || i + 1 == steps.size();
  };
  double total_work = 0.0;
  double num_points = 0.0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    num_points += count_points(steps[i]);
    if (is_due(i)) total_work += num_points;
  }

  Replay replay;
  replay.mode = "batch";
  const std::int64_t resident_before = resident_bytes_at_begin();
  ProgressTeller teller(replay.mode, steps.size(), total_work, on_progress);
  PointCloud cloud;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    put_into(cloud, steps[i]);
    cloud.take_change();
    if (!is_due(i)) continue;
    MeasuredRun& run = replay.runs.emplace_back();
    run.step = static_cast<std::int32_t>(i);
    run.map_points = cloud.num_live();

    const CloudChange everything = cloud.everything();
    const Stopwatch watch;
    const auto engine = make_engine("batch", cloud, config);
    run.statistics = engine->update(everything);
    run.engine_ms = watch.wall_ms();
    run.engine_cpu_ms = watch.cpu_ms();

    teller.tell(run, static_cast<double>(run.map_points));
    if (i + 1 < steps.size()) continue;
    replay.resident_growth_bytes = process_memory().resident_bytes - resident_before;
    replay.labels = labels_by_slice(cloud, engine->components());
  }
  return replay;
}

}  // namespace kintsugi::segmenter
