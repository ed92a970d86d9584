#include "segmenter/evaluation/replay.hpp"

#include <chrono>
#include <stdexcept>

#include <malloc.h>

#include "segmenter/core/point_cloud.hpp"
#include "segmenter/core/segment_ids.hpp"
#include "segmenter/evaluation/process_memory.hpp"

namespace kintsugi::segmenter {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// Tells how far a replay is, and guesses the rest from the work that is left.
class ProgressTeller {
 public:
  ProgressTeller(std::string mode, std::size_t num_slices, double total_work,
                 const OnReplayProgress& on_progress)
      : on_progress_(on_progress), total_work_(total_work) {
    progress_.mode = std::move(mode);
    progress_.num_slices = static_cast<std::int32_t>(num_slices);
  }

  void tell(const SliceRun& run, double work) {
    work_ += work;
    progress_.slice = run.slice_index + 1;
    progress_.map_points = run.map_points;
    progress_.last_ms = run.engine_ms;
    progress_.rest_s = work_ > 0.0 ? 1e-3 * ms_since(start_) * (total_work_ - work_) / work_ : 0.0;
    if (on_progress_) on_progress_(progress_);
  }

 private:
  const OnReplayProgress& on_progress_;
  double total_work_;
  double work_ = 0.0;
  Clock::time_point start_ = Clock::now();
  ReplayProgress progress_;
};

/// Memory that earlier replays have freed goes back first, so that growth is the replay's own.
std::int64_t resident_bytes_at_begin() {
  malloc_trim(0);
  return process_memory().resident_bytes;
}

double count_points(std::span<const CloudSlice> slices) {
  double count = 0.0;
  for (const CloudSlice& slice : slices) count += static_cast<double>(slice.points_W.size());
  return count;
}

}  // namespace

Replay replay_incrementally(std::span<const CloudSlice> slices, const std::string& mode,
                            const EngineConfig& config, const OnReplayProgress& on_progress) {
  Replay replay;
  replay.mode = mode;
  const std::int64_t resident_before = resident_bytes_at_begin();
  PointCloud cloud;
  const auto engine = make_engine(mode, cloud, config);
  SegmentIds ids;
  ProgressTeller teller(mode, slices.size(), count_points(slices), on_progress);
  for (const CloudSlice& slice : slices) {
    SliceRun& run = replay.runs.emplace_back();
    run.slice_index = static_cast<std::int32_t>(replay.runs.size()) - 1;
    cloud.add_slice(slice.id, slice.points_W);

    const CloudChange change = cloud.take_change();
    const auto start = Clock::now();
    run.statistics = engine->update(change);
    run.engine_ms = ms_since(start);
    const auto ids_start = Clock::now();
    ids.update(cloud, change, engine->components(), engine->changed());
    run.ids_ms = ms_since(ids_start);

    run.map_points = cloud.num_live();
    teller.tell(run, static_cast<double>(slice.points_W.size()));
  }
  replay.resident_growth_bytes = process_memory().resident_bytes - resident_before;
  replay.labels = canonical_labels(engine->components());
  replay.num_rejected = cloud.num_rejected();
  return replay;
}

Replay replay_batch(std::span<const CloudSlice> slices, int every, const EngineConfig& config,
                    const OnReplayProgress& on_progress) {
  if (every < 1) {
    throw std::invalid_argument("every is " + std::to_string(every) + ", must be >= 1");
  }
  const auto is_due = [&](std::size_t i) {
    return (i + 1) % static_cast<std::size_t>(every) == 0 || i + 1 == slices.size();
  };
  double total_work = 0.0;
  double num_points = 0.0;
  for (std::size_t i = 0; i < slices.size(); ++i) {
    num_points += static_cast<double>(slices[i].points_W.size());
    if (is_due(i)) total_work += num_points;
  }

  Replay replay;
  replay.mode = "batch";
  const std::int64_t resident_before = resident_bytes_at_begin();
  ProgressTeller teller(replay.mode, slices.size(), total_work, on_progress);
  PointCloud cloud;
  for (std::size_t i = 0; i < slices.size(); ++i) {
    cloud.add_slice(slices[i].id, slices[i].points_W);
    if (!is_due(i)) continue;
    SliceRun& run = replay.runs.emplace_back();
    run.slice_index = static_cast<std::int32_t>(i);
    run.map_points = cloud.num_live();

    const CloudChange everything = cloud.everything();
    const auto start = Clock::now();
    const auto engine = make_engine("batch", cloud, config);
    run.statistics = engine->update(everything);
    run.engine_ms = ms_since(start);

    teller.tell(run, static_cast<double>(cloud.num_live()));
    if (i + 1 < slices.size()) continue;
    replay.resident_growth_bytes = process_memory().resident_bytes - resident_before;
    replay.labels = canonical_labels(engine->components());
  }
  replay.num_rejected = cloud.num_rejected();
  return replay;
}

}  // namespace kintsugi::segmenter
