#include "mapper/process/mapper_process.hpp"

#include <chrono>
#include <memory>
#include <stdexcept>
#include <thread>
#include <utility>

#include <spdlog/fmt/fmt.h>

#include "lcmtypes/base/atomic_file.hpp"
#include "lcmtypes/base/logger.hpp"
#include "lcmtypes/base/process_memory.hpp"
#include "lcmtypes/base/stop_signal.hpp"
#include "lcmtypes/channels.hpp"
#include "mapper/output/part_file.hpp"
#include "mapper/process/linger.hpp"
#include "mapper/process/state_text.hpp"
#include "mapper/session/mapped_frames.hpp"
#include "mapper/source/frames/paced_source.hpp"

namespace kintsugi::mapper {
namespace {

using std::chrono::milliseconds;

constexpr double kStatusPeriod_ms = 300.0;
constexpr milliseconds kFrameWait{100};  ///< the longest delay of a status
constexpr milliseconds kRoomWait{5};

void log_notice(const SourceNotice& notice) {
  const bool is_good = notice.kind == SourceNotice::Kind::kInformation ||
                       notice.kind == SourceNotice::Kind::kResumed;
  spdlog::log(is_good ? spdlog::level::info : spdlog::level::warn, "{}", notice.text);
}

SourceConfig source_config(const Options& options) {
  SourceConfig config = options.source;
  config.stop_requested = [] { return stop_requested(); };
  config.notify = log_notice;
  return config;
}

std::unique_ptr<FrameSource> session_source(std::unique_ptr<FrameSource> source,
                                            const Options& options, Resumption& resumption) {
  const bool is_recording = source->status().frames_total >= 0;
  source = resumption.attach(std::move(source));
  if (!is_recording || options.source.replay) return source;
  return std::make_unique<PacedSource>(std::move(source), resumption.last_mapped_utime(),
                                       stop_requested, log_notice);
}

MapperPipeline::Config pipeline_config(const Options& options, MapFiles& map_files) {
  MapperPipeline::Config config = options.pipeline;
  config.keeps_own_surface = !options.join.empty();
  config.slices.on_points = map_files.points_sink();
  config.slices.on_mesh = map_files.mesh_sink();
  return config;
}

}  // namespace

MapperProcess::MapperProcess(const Options& options, SessionStore& store, Resumption& resumption)
    : options_(options),
      store_(store),
      resumption_(resumption),
      reader_(
          source_config(options),
          [&](auto source) { return session_source(std::move(source), options, resumption); },
          options.source.replay ? 1 : FusionPace::kMaxWaiting),
      map_files_(options.cloud_file, options.mesh_file),
      pipeline_(pipeline_config(options, map_files_)),
      publisher_(publisher_config(options, resumption.session()), store),
      views_(options.view_rate_hz) {
  if (pipeline_.loops() != nullptr) {
    guest_receiver_.emplace(options.lcm_url, options.map_name, resumption.session());
  }
  if (!options.timings_file.empty()) frame_log_.emplace(options.timings_file);
  if (options.store_frames) {
    const std::int64_t session = resumption.session();
    frame_store_.emplace(store.stream(channels::kRgbdFrame, session), session,
                         resumption.last_stored_utime());
  }
}

void MapperProcess::run() {
  log_start();
  map_frames();
  publish_rest();
  commit_map_files();
  write_paths();
  log_summary();
  lingering_ = true;
  linger(publisher_, options_.linger_s, [this] { publish_status(); });
  throw_failures();
}

void MapperProcess::map_frames() {
  publish_status();
  cpu_ms_ = process_cpu_ms();
  while (!reader_.finished() && !stop_requested()) {
    if (options_.max_frames > 0 && statistics_.frames() >= options_.max_frames) return;
    publish_status_when_due();
    if (!publisher_.has_room()) {
      std::this_thread::sleep_for(kRoomWait);
    } else if (const auto frame = reader_.next(kFrameWait)) {
      map_frame(*frame);
    }
  }
}

void MapperProcess::map_frame(const TimedFrame& read) {
  const RgbdFrame& frame = read.frame;
  Stopwatch stopwatch;
  if (frame_store_) frame_store_->add(frame);
  publish_new_keyframe();
  take_guests();
  FrameResult result = pipeline_.process(frame, is_to_be_fused(read));
  const TrackingResult& tracking = result.tracking;
  part_ = result.part;
  if (result.part_begun) {
    log_part(*result.part_begun, frame);
    statistics_.begin_part();
  }
  log_change_of_state(result, frame);
  if (result.correction) log_correction(*result.correction, frame);
  log_guests_and_joined(fmt::format("frame {}", frame.frame_index));
  if (is_located(tracking.state) && !options_.online_path_file.empty()) {
    online_paths_[result.part].push_back({frame.utime, tracking.X_WC});
  }

  const std::size_t num_slices = result.slices.size();
  const double mapped_ms = stopwatch.elapsed_ms();
  publisher_.publish_frame(frame);
  publish_result(frame, result);
  FrameTimings timings;
  timings.stages = result.times;
  timings.frame_ms = stopwatch.elapsed_ms();
  timings.publish_ms = timings.frame_ms - mapped_ms;
  measure(read, timings);
  statistics_.add(tracking, result.is_fused, timings);
  if (frame_log_) {
    frame_log_->append(frame, result.part, tracking, result.is_fused, num_slices, timings);
  }
  if (resumption_.was_mapped(frame.utime)) ++frames_resumed_;
  last_utime_ = frame.utime;
}

/// A resumed session repeats what was done; a replay fuses every frame.
bool MapperProcess::is_to_be_fused(const TimedFrame& read) {
  if (options_.source.replay) return true;
  const auto was_fused = resumption_.was_fused(read.frame.utime);
  return was_fused ? *was_fused : pace_.fuses(read.num_waiting);
}

/// For the mapper whose map this one joins.
void MapperProcess::publish_new_keyframe() {
  if (options_.join.empty()) return;
  if (auto keyframe = pipeline_.take_keyframe()) publisher_.publish_keyframe(*std::move(keyframe));
}

void MapperProcess::take_guests() {
  if (!guest_receiver_) return;
  GuestReceiver::News news = guest_receiver_->take();
  for (KeyframeMessage& keyframe : news.keyframes) pipeline_.add_guest(std::move(keyframe));
  for (CloudSlice& slice : news.slices) pipeline_.add_guest(std::move(slice));
}

void MapperProcess::publish_result(const RgbdFrame& frame, FrameResult& result) {
  const TrackingResult& tracking = result.tracking;
  if (!resumption_.was_mapped(frame.utime)) {
    if (is_located(tracking.state) && !result.is_fused) {
      store_.add(kTrackedOnlyChannel,
                 encode_mapped_frames(resumption_.session(), {&frame.utime, 1}));
    }
    publisher_.publish_pose(
        {frame.utime, 0, frame.frame_index, tracking.state, tracking.X_WC, result.part});
  }
  if (auto view = views_.next(frame, tracking)) {
    view->part = result.part;
    publisher_.publish_view(*std::move(view));
  }
  publisher_.publish_slices(std::move(result.slices));
}

/// Fills in the times of the other threads.
void MapperProcess::measure(const TimedFrame& read, FrameTimings& timings) {
  timings.read_ms = read.read_ms;
  timings.convert_ms = read.convert_ms;
  const double cpu_ms = process_cpu_ms();
  timings.cpu_ms = cpu_ms - std::exchange(cpu_ms_, cpu_ms);
  const double extraction_ms = pipeline_.extraction_ms();
  timings.extract_ms = extraction_ms - std::exchange(extraction_ms_, extraction_ms);
}

void MapperProcess::publish_rest() {
  finished_ = resumption_.has_caught_up(last_utime_);
  if (finished_) {
    publish_new_keyframe();
    take_guests();
    publisher_.publish_slices(pipeline_.finish());
    log_guests_and_joined("end");
  } else {
    spdlog::warn(
        "stopped before all frames that were mapped before are mapped again: resume once more");
  }
  guest_receiver_.reset();  // nothing is added to the map any more
  publisher_.flush();
  publish_status();
}

void MapperProcess::commit_map_files() {
  map_files_.commit([&](int patch) { return pipeline_.place_of_patch(patch); });
}

void MapperProcess::write_paths() {
  write_path_files(options_.output_path_file, pipeline_.corrected_paths());
  write_path_files(options_.online_path_file, online_paths_);
}

/// One file for each part; that of part 0 also where it is empty. What cannot be written loses
/// nothing else.
void MapperProcess::write_path_files(const std::string& name, std::map<int, Trajectory> paths) {
  if (name.empty()) return;
  paths.try_emplace(0);
  for (const auto& [part, path] : paths) {
    try {
      AtomicFile file(part_file(name, part));
      write_tum(file.stream(), path);
      file.commit();
      spdlog::info("camera path of {} poses in {}", path.size(), part_file(name, part).string());
    } catch (const std::exception& error) {
      spdlog::error("{}", error.what());
      path_files_failed_ = true;
    }
  }
}

void MapperProcess::publish_status() {
  MapperStatus status;
  statistics_.report(status);
  status.part = part_;
  status.parts = num_parts_;
  // The pose of a disconnected camera is unknown.
  said_interrupted_ = reader_.interrupted();
  if (said_interrupted_) status.state = TrackingState::kLost;
  status.device = options_.source.device;
  status.finished = finished_;
  status.lingering = lingering_;
  status.frames_resumed = frames_resumed_;
  const SourceStatus source = reader_.status();
  status.frames_total = source.frames_total;
  status.frames_dropped = source.counts.frames_dropped;
  status.keyframes = pipeline_.num_keyframes();
  if (const LoopClosure* const loops = pipeline_.loops()) {
    status.loops = loops->num_loops();
    status.loops_contradicted = loops->num_contradicted();
    status.corrections = loops->deformation().number();
  }
  status.guests = static_cast<std::int32_t>(pipeline_.guests().reports().size());
  status.guest_patches = pipeline_.guests().num_patches();
  const DepthNoise& noise = pipeline_.noise();
  status.noise_base_m = noise.base_m;
  status.noise_share = noise.share;
  status.noise_growth_per_m = noise.growth_per_m;
  status.blocks = pipeline_.num_blocks();
  status.volume_bytes = pipeline_.volume_bytes();
  publisher_.publish_status(std::move(status));
  status_clock_ = Stopwatch();
}

/// Periodically, and at once when the camera is disconnected or comes back.
void MapperProcess::publish_status_when_due() {
  const bool is_news = reader_.interrupted() != said_interrupted_;
  if (is_news || status_clock_.elapsed_ms() >= kStatusPeriod_ms) publish_status();
}

void MapperProcess::log_start() const {
  const auto& volume = options_.pipeline.volume;
  const SourceStatus source = reader_.status();
  spdlog::info("device '{}'{}, {} frames", source.name, options_.source.replay ? ", replayed" : "",
               source.frames_total < 0 ? "unknown" : std::to_string(source.frames_total));
  const std::string region = volume.region == RegionShape::kCube
                                 ? fmt::format("a cube of {:.2f} m", volume.volume_size_m)
                                 : fmt::format("{:.2f} m around the camera", volume.max_range_m);
  spdlog::info("volume: {}; voxel {:.2f} mm, map '{}', session {}", region,
               1e3 * volume.resolution_m, options_.map_name, resumption_.session());
}

void MapperProcess::log_change_of_state(const FrameResult& result, const RgbdFrame& frame) {
  const TrackingResult& tracking = result.tracking;
  if (tracking.state == last_state_) return;
  last_state_ = tracking.state;
  if (tracking.state == TrackingState::kLost) {
    const RegistrationQuality& quality = tracking.quality;
    const std::string_view first = first_reason_text(tracking);
    spdlog::warn(
        "frame {}: lost, {}{} (overlap {:.2f}, inliers {:.2f}, behind {:.2f}, in front {:.2f}, "
        "rms {:.1f} mm, sigma {:.1f} mm)",
        frame.frame_index, reason_text(tracking),
        first.empty() ? "" : fmt::format("; at first: {}", first), quality.overlap_share,
        quality.inlier_share, quality.behind_share, quality.in_front_share, 1e3 * quality.rms_m,
        1e3 * quality.sigma_m);
  } else {
    spdlog::info("frame {}: {}", frame.frame_index, to_string(tracking.state));
  }
}

void MapperProcess::log_part(const PartBegun& begun, const RgbdFrame& frame) const {
  spdlog::warn(
      "frame {}: lost for {:g} s (--restart-after), {}; part {} of the map begins, apart from the "
      "others until a loop joins them",
      frame.frame_index, options_.pipeline.restart_after_s, reason_text(begun.lost), begun.part);
}

/// @param when the frame, or "end": the last guests and loops come after the last frame
void MapperProcess::log_guests_and_joined(std::string_view when) {
  for (const GuestReport& guest : pipeline_.guests().reports()) {
    const std::string who =
        fmt::format("{}: the mapper of map '{}' (session {})", when, guest.map_name, guest.session);
    if (!guest.problem.empty() && guests_refused_.insert(guest.session).second) {
      spdlog::warn("{} cannot join this map: {}", who, guest.problem);
    } else if (guest.keyframes > 0 && guests_named_.insert(guest.session).second) {
      spdlog::info("{} joins this map: a part of its own until a loop joins them", who);
    }
  }
  num_parts_ = pipeline_.num_parts();
  const int num_joined = pipeline_.num_parts_begun() - num_parts_;
  if (num_joined <= std::exchange(num_joined_, num_joined)) return;
  spdlog::info("{}: loops have joined parts of the map: {}", when,
               num_parts_ == 1 ? "it is one again" : fmt::format("{} are still apart", num_parts_));
}

void MapperProcess::log_correction(const MapCorrection& correction, const RgbdFrame& frame) {
  spdlog::info("frame {}: {} loops closed so far, keyframes moved by up to {:.0f} mm{}",
               frame.frame_index, correction.loops.size(), 1e3 * correction.largest_motion_m,
               correction.num_contradicted == 0
                   ? ""
                   : fmt::format("; {} loops contradicted", correction.num_contradicted));
}

void MapperProcess::log_summary() const {
  const double elapsed_s = 1e-3 * run_clock_.elapsed_ms();
  const SourceStatus source = reader_.status();
  const SourceCounts& counts = source.counts;
  if (reader_.finished()) spdlog::info("end: {}", source.end_reason);
  spdlog::info(
      "{} frames in {:.1f} s ({:.1f} ms each, {:.1f} ms of CPU): {} located ({} not fused for lack "
      "of time), {} lost, found again {} times, {} dropped, {} bad, {} interruptions",
      statistics_.frames(), elapsed_s, statistics_.mean_frame_ms(), statistics_.mean_cpu_ms(),
      statistics_.frames_tracked(), statistics_.frames_tracked_only(), statistics_.frames_lost(),
      statistics_.frames_relocalised(), counts.frames_dropped, counts.frames_bad,
      counts.interruptions);
  const MapPublisher::Published published = publisher_.published();
  spdlog::info("{} slices, {} points, {} messages published", published.slices, published.points,
               published.chunks);
  if (const LoopClosure* const loops = pipeline_.loops(); loops && loops->num_loops() > 0) {
    spdlog::info("{} loops closed, {} contradicted; the map was corrected {} times",
                 loops->num_loops(), loops->num_contradicted(), loops->deformation().number());
  }
  spdlog::info(
      "{:.0f} MB of memory at most; {:.0f} MB kept of what left the volume, for when the camera "
      "comes back",
      1e-6 * static_cast<double>(process_memory().peak_resident_bytes),
      1e-6 * static_cast<double>(pipeline_.kept_bytes()));
  if (statistics_.parts().size() > 1) log_parts();
}

void MapperProcess::log_parts() const {
  std::string text;
  for (const RunStatistics::Part& part : statistics_.parts()) {
    text += fmt::format("{}{} of {}", text.empty() ? "" : ", ", part.frames_tracked, part.frames);
  }
  spdlog::info("{} parts, frames located in each: {}; {}", statistics_.parts().size(), text,
               num_parts_ == 1 ? "loops have joined them all"
                               : fmt::format("{} are apart from each other", num_parts_));
}

void MapperProcess::throw_failures() const {
  reader_.rethrow_failure();
  const SourceStatus source = reader_.status();
  if (reader_.finished() && !source.ended_well) {
    throw std::runtime_error("the device ended early; the frames before that are mapped: " +
                             source.end_reason);
  }
  if (map_files_.failed() || path_files_failed_ || (frame_log_ && frame_log_->failed())) {
    throw std::runtime_error("a file could not be written, see above; everything else is complete");
  }
}

}  // namespace kintsugi::mapper
