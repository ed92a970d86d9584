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
  int warm_up_frames = 10;  ///< mapped and not counted: memory is touched for the first time
  int threads = 2;          ///< of the parallel stages
  /// Waits, before a frame is mapped, until the device has made the images that it makes ahead: for
  /// a device that renders, which costs many times what mapping does. No row has that wait.
  bool device_rests = false;
  MapperPipeline::Config pipeline;
};

/// One frame, milliseconds. CPU times are of the whole process, so those of the stages also have
/// what the source's and the slice worker's threads did meanwhile.
struct FrameSample {
  double read_ms = 0.0;     ///< until the frame is there, without conversion
  double convert_ms = 0.0;  ///< to metres, undistorted
  double read_convert_cpu_ms = 0.0;
  StageTimes stages;
  StageTimes stages_cpu;
  double frame_ms = 0.0;  ///< all of it, from asking for the frame to its model for the next one
  double frame_cpu_ms = 0.0;
  bool slice_left = false;
};

struct FrameRun {
  FrameRunConfig config;
  std::vector<FrameSample> samples;
  // Of threads beside the parallel stages, CPU time in milliseconds a frame.
  double source_threads_cpu_ms = 0.0;  ///< the device's driver: reading and decoding
  double slice_worker_cpu_ms = 0.0;    ///< extraction of slices
  std::int64_t frames_lost = 0;
  std::int64_t slices = 0;
  std::int64_t blocks = 0;  ///< in the cube at the end
};

/// Reads and maps in one thread, one after the other: nothing but what the device's own driver
/// decodes ahead is read while a frame is mapped.
/// @throws what opening or reading the device throws
FrameRun run_frames(const FrameRunConfig& config);

}  // namespace kintsugi::mapper::bench
