#include "tests/bench/frame_run.hpp"

#include <chrono>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include <oneapi/tbb/global_control.h>

#include "lcmtypes/base/stopwatch.hpp"
#include "mapper/source/open_source.hpp"
#include "tests/bench/frame_threads.hpp"

namespace kintsugi::mapper::bench {
namespace {

/// CPU time of a set of threads since construction.
class CpuOfThreads {
 public:
  explicit CpuOfThreads(Threads threads) : threads_(std::move(threads)), start_ms_(total_ms()) {}
  double total_ms() const { return cpu_ms(threads_); }
  double since_start_ms() const { return total_ms() - start_ms_; }
  void restart() { start_ms_ = total_ms(); }

 private:
  Threads threads_;
  double start_ms_;
};

/// Waits until the threads have been idle for a while.
void wait_for_rest(const CpuOfThreads& threads) {
  constexpr std::chrono::milliseconds kWhile{5};
  constexpr double kNothing_ms = 0.01;
  double before_ms = threads.total_ms();
  for (;;) {
    std::this_thread::sleep_for(kWhile);
    const double now_ms = threads.total_ms();
    if (now_ms - before_ms < kNothing_ms) return;
    before_ms = now_ms;
  }
}

std::optional<FrameSample> run_frame(FrameSource& source, const CpuOfThreads& source_cpu,
                                     MapperPipeline& pipeline, FrameRun& run) {
  FrameSample sample;
  const double cpu_before_ms = process_cpu_ms();
  const double converted_before_ms = source.status().counts.convert_ms;
  Stopwatch stopwatch;
  const std::optional<RgbdFrame> frame = source.next();
  if (!frame) return std::nullopt;
  sample.convert_ms = source.status().counts.convert_ms - converted_before_ms;
  sample.read_ms = stopwatch.lap_ms() - sample.convert_ms;
  if (run.config.device_rests) wait_for_rest(source_cpu);
  sample.read_convert_cpu_ms = process_cpu_ms() - cpu_before_ms;
  stopwatch.lap_ms();
  const FrameResult result = pipeline.process(*frame);
  sample.frame_ms = sample.read_ms + sample.convert_ms + stopwatch.lap_ms();
  sample.frame_cpu_ms = process_cpu_ms() - cpu_before_ms;
  sample.stages = result.times;
  sample.stages_cpu = result.cpu_times;
  sample.slice_left = result.slices_left > 0;
  run.frames_lost += result.tracking.state == TrackingState::kLost ? 1 : 0;
  run.slices += result.slices_left;
  return sample;
}

}  // namespace

FrameRun run_frames(const FrameRunConfig& config) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(config.threads));
  FrameRun run{.config = config, .samples = {}};
  const Threads before_source = current_threads();
  SourceConfig source_config;
  source_config.device = config.device;
  const std::unique_ptr<FrameSource> source = open_frame_source(source_config);
  const Threads with_source = current_threads();
  MapperPipeline pipeline(config.pipeline);
  CpuOfThreads source_cpu(new_threads(with_source, before_source));
  CpuOfThreads worker_cpu(new_threads(current_threads(), with_source));
  for (int i = 0; i < config.warm_up_frames + config.frames; ++i) {
    if (i == config.warm_up_frames) {
      source_cpu.restart();
      worker_cpu.restart();
      run.frames_lost = run.slices = 0;
    }
    const auto sample = run_frame(*source, source_cpu, pipeline, run);
    if (!sample) break;
    if (i >= config.warm_up_frames) run.samples.push_back(*sample);
  }
  if (!run.samples.empty()) {
    const auto frames = static_cast<double>(run.samples.size());
    run.source_threads_cpu_ms = source_cpu.since_start_ms() / frames;
    run.slice_worker_cpu_ms = worker_cpu.since_start_ms() / frames;
  }
  run.blocks = pipeline.num_blocks();
  return run;
}

}  // namespace kintsugi::mapper::bench
