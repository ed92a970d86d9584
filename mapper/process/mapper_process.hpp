#pragma once

#include <map>
#include <optional>
#include <set>
#include <string_view>

#include "lcmtypes/base/stopwatch.hpp"
#include "lcmtypes/trajectory.hpp"
#include "mapper/core/mapper_pipeline.hpp"
#include "mapper/process/camera_views.hpp"
#include "mapper/process/frame_log.hpp"
#include "mapper/process/frame_reader.hpp"
#include "mapper/process/fusion_pace.hpp"
#include "mapper/process/guest_receiver.hpp"
#include "mapper/process/map_files.hpp"
#include "mapper/process/map_publisher.hpp"
#include "mapper/process/options.hpp"
#include "mapper/process/run_statistics.hpp"
#include "mapper/session/resumption.hpp"
#include "mapper/session/stored_frames.hpp"

namespace kintsugi::mapper {

/// Reads frames, maps them, and publishes the result on the bus. Parts of the map that no loop has
/// joined at the end have files of their own.
class MapperProcess {
 public:
  /// Opens the device and the bus. `store` and `resumption` must outlive this.
  /// @throws std::runtime_error when one of them cannot be opened
  MapperProcess(const Options& options, SessionStore& store, Resumption& resumption);

  /// Maps until the device ends, max_frames, or a stop signal. Then it publishes the final slice,
  /// sends all messages, writes the output files, and stays to answer requests. A resumed session
  /// stays unfinished when it is stopped before all frames that were mapped before are mapped
  /// again.
  /// @throws std::runtime_error when reading, sending or writing failed, or the recording ended
  ///   early; frames before the failure are mapped and their slices sent
  void run();

 private:
  void map_frames();
  void map_frame(const TimedFrame& read);
  bool is_to_be_fused(const TimedFrame& read);
  void publish_new_keyframe();
  void take_guests();
  void publish_result(const RgbdFrame& frame, FrameResult& result);
  void measure(const TimedFrame& read, FrameTimings& timings);
  void publish_rest();
  void commit_map_files();
  void write_paths();
  void write_path_files(const std::string& name, std::map<int, Trajectory> paths);
  void publish_status();
  void publish_status_when_due();
  void log_start() const;
  void log_change_of_state(const FrameResult& result, const RgbdFrame& frame);
  void log_part(const PartBegun& begun, const RgbdFrame& frame) const;
  void log_guests_and_joined(std::string_view when);
  static void log_correction(const MapCorrection& correction, const RgbdFrame& frame);
  void log_summary() const;
  void log_parts() const;
  void throw_failures() const;

  const Options options_;
  SessionStore& store_;
  Resumption& resumption_;
  FrameReader reader_;
  MapFiles map_files_;  ///< before pipeline_, whose worker writes to it
  MapperPipeline pipeline_;
  MapPublisher publisher_;
  std::optional<GuestReceiver> guest_receiver_;  ///< none: the map is not corrected by loops
  std::set<std::int64_t> guests_named_;          ///< sessions that the log has named
  std::set<std::int64_t> guests_refused_;
  CameraViews views_;
  FusionPace pace_;
  RunStatistics statistics_;
  std::optional<FrameLog> frame_log_;
  std::optional<FrameStore> frame_store_;
  /// Of the frames that were tracked or given, as believed at each frame; by part of the map. Only
  /// where it is to be written.
  std::map<int, Trajectory> online_paths_;
  TrackingState last_state_ = TrackingState::kStarting;
  int part_ = 0;                ///< of the map, in which the camera is
  int num_parts_ = 1;           ///< that no loop has joined, after the last frame
  int num_joined_ = 0;          ///< parts that loops have joined to others, after the last frame
  double cpu_ms_ = 0.0;         ///< of the process, at the last frame
  double extraction_ms_ = 0.0;  ///< of the pipeline, at the last frame
  Stopwatch run_clock_;
  Stopwatch status_clock_;
  bool said_interrupted_ = false;  ///< the last status reported a disconnected camera
  bool finished_ = false;          ///< every slice is published
  bool path_files_failed_ = false;
  bool lingering_ = false;
  std::int64_t last_utime_ = -1;  ///< of the last mapped frame
  std::int64_t frames_resumed_ =
      0;  ///< frames mapped again that were mapped before the interruption
};

}  // namespace kintsugi::mapper
