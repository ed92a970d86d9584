#pragma once

#include <optional>
#include <vector>

#include "lcmtypes/base/stopwatch.hpp"
#include "lcmtypes/trajectory.hpp"
#include "mapper/core/mapper_pipeline.hpp"
#include "mapper/process/frame_log.hpp"
#include "mapper/process/frame_reader.hpp"
#include "mapper/process/map_files.hpp"
#include "mapper/process/map_publisher.hpp"
#include "mapper/process/options.hpp"
#include "mapper/process/run_statistics.hpp"
#include "mapper/session/resumption.hpp"
#include "mapper/session/stored_frames.hpp"

namespace kintsugi::mapper {

/// Reads frames, maps them, says on the bus what came of it.
class MapperProcess {
 public:
  /// Opens the device and the bus. `log` and `resumption` must outlive this.
  /// @throws std::runtime_error when either cannot be opened
  MapperProcess(const Options& options, SessionStore& store, Resumption& resumption);

  /// Until the device ends, max_frames, or a stop signal. Then the final slice is published and
  /// everything sent, and the files asked for written; then it stays to answer requests. Stopped
  /// before it has made again what an interrupted session had, it leaves the session unfinished.
  /// @throws std::runtime_error when reading, sending or writing failed or the recording ended
  ///   before its time; what could be mapped and sent before that was
  void run();

 private:
  void map_frames();
  void map_frame(const TimedFrame& read);
  void publish_frame(const RgbdFrame& frame, FrameResult& result);
  void publish_slices(std::vector<CloudSlice> slices);
  void measure(const TimedFrame& read, FrameTimings& timings);
  void publish_rest();
  void write_path();
  void publish_status();
  void publish_status_when_due();
  void log_start() const;
  void log_change_of_state(const FrameResult& result, const RgbdFrame& frame);
  void log_summary() const;
  void throw_failures() const;

  const Options options_;
  Resumption& resumption_;
  FrameReader reader_;
  MapFiles map_files_;  ///< before the pipeline, whose worker writes to it
  MapperPipeline pipeline_;
  MapPublisher publisher_;
  RunStatistics statistics_;
  std::optional<FrameLog> frame_log_;
  std::optional<FrameStore> frame_store_;
  Trajectory path_;  ///< of the frames that were located
  TrackingState last_state_ = TrackingState::kStarting;
  double cpu_ms_ = 0.0;         ///< of the process, at the last frame
  double extraction_ms_ = 0.0;  ///< of the pipeline, at the last frame
  Stopwatch run_clock_;
  Stopwatch status_clock_;
  bool said_interrupted_ = false;  ///< in the last status
  bool finished_ = false;          ///< every slice is published
  bool lingering_ = false;
  std::int64_t last_utime_ = -1;     ///< of the last mapped frame
  std::int64_t frames_resumed_ = 0;  ///< mapped, the ones that had been mapped before
};

}  // namespace kintsugi::mapper
