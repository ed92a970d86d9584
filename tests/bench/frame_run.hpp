#pragma once
// The mapper's pipeline over a device, timed frame by frame.

#include <cstdint>
#include <string>
#include <vector>

#include "mapper/core/mapper_pipeline.hpp"

namespace kintsugi::mapper::bench {

struct FrameRunConfig {
  std::string device;  ///< as SourceConfig names it
  int frames = 300;
  int warm_up_frames = 10;  ///< mapped first and not measured
  int threads = 2;          ///< of the parallel stages
  /// Before a frame is mapped, waits until the device is idle: for a device that renders images
  /// ahead, which takes longer than mapping. No measured time includes this wait.
  bool device_rests = false;
  MapperPipeline::Config pipeline;
};

/// Times of one frame, ms. CPU times are of the whole process: those of a stage include what the
/// threads of the source and the slice worker did meanwhile.
struct FrameSample {
  double read_ms = 0.0;     ///< waiting for the frame, without conversion
  double convert_ms = 0.0;  ///< to metres, undistorted
  double read_convert_cpu_ms = 0.0;
  StageTimes stages;
  StageTimes stages_cpu;
  double frame_ms = 0.0;  ///< from requesting the frame to the model for the next frame
  double frame_cpu_ms = 0.0;
  bool slice_left = false;
};

struct FrameRun {
  FrameRunConfig config;
  std::vector<FrameSample> samples;
  // CPU time of threads other than those of the parallel stages, ms a frame.
  double source_threads_cpu_ms = 0.0;  ///< the device's driver: reading and decoding
  double slice_worker_cpu_ms = 0.0;    ///< extraction of slices
  std::int64_t frames_lost = 0;
  std::int64_t slices = 0;
  std::int64_t blocks = 0;  ///< in the volume at the end
};

/// Reads and maps frame after frame in one thread. Only the driver of the device may decode ahead
/// while a frame is mapped.
/// @throws what opening or reading the device throws
FrameRun run_frames(const FrameRunConfig& config);

}  // namespace kintsugi::mapper::bench
