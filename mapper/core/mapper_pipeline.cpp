#include "mapper/core/mapper_pipeline.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <string>
#include <utility>

#include "lcmtypes/base/argument_check.hpp"
#include "lcmtypes/trajectory.hpp"
#include "mapper/core/frame/camera.hpp"
#include "mapper/core/frame/covered_share.hpp"
#include "mapper/core/frame/sensors.hpp"
#include "mapper/core/fusion/truncation.hpp"
#include "mapper/core/guests/keyframe_message.hpp"
#include "mapper/core/registration/motion_size.hpp"

namespace kintsugi::mapper {
namespace {

/// Of their keyframes, so that those of the camera are compared in time.
constexpr std::size_t kMaxGuestsWaiting = 2;

}  // namespace

MapperPipeline::MapperPipeline(const Config& config)
    : config_((config.validate(), config)),
      integrator_(config.integrator),
      raycaster_(config.raycaster),
      tracker_(config.tracker),
      noise_(config.noise.value_or(DepthNoise())),
      relocalizer_(config.relocalizer),
      loops_(config.closes_loops()
                 ? std::make_unique<LoopClosure>(config.loop_closure(), relocalizer_.keyframes())
                 : nullptr),
      guests_(config.volume.resolution_m),
      restart_rule_(config.given_path.empty() ? config.restart_after_s : 0.0),
      map_(config, loops_.get()) {}

FrameResult MapperPipeline::process(const RgbdFrame& measured, bool fuse) {
  FrameResult result;
  StageClock clock;
  const RgbdFrame frame = cleaned(measured);
  utime_ = frame.utime;
  const TrackingInput input = prepare(frame);
  clock.end_of(&StageTimes::prepare_ms);
  result.tracking = locate(input);
  if (restart_rule_.is_due(frame.utime, result.tracking.state) && can_be_tracked_in(input)) {
    restart_rule_.count_anew();
    result.part_begun = begin_part(std::move(result.tracking));
    result.tracking = locate(input);
  }
  clock.end_of(&StageTimes::track_ms);
  const bool located = is_located(result.tracking.state);
  result.is_fused = located && (fuse || !model_ || result.tracking.found_by_keyframe);
  if (result.is_fused) {
    fuse_into_map(frame, input, result, clock);
  } else if (located) {
    X_WC_ = result.tracking.X_WC;
    follow(result.tracking, false, input.utime);
  } else if (model_) {
    look_where_expected(input);
    clock.end_of(&StageTimes::raycast_ms);
  }
  if (loops_) {
    result.correction = correct(loops_->take_due(frame.utime));
    result.tracking.X_WC = map_.camera_at().place.X_WU * result.tracking.X_WC;
    clock.end_of(&StageTimes::loops_ms);
  }
  map_.send_due(camera());
  if (loops_) map_.send(guests_.take_in(*loops_, utime_, kMaxGuestsWaiting), camera());
  clock.end_of(&StageTimes::patches_ms);
  result.part = map_.camera_at().place.part;
  result.times = clock.wall();
  result.cpu_times = clock.cpu();
  result.slices = map_.take_finished();
  return result;
}

void MapperPipeline::fuse_into_map(const RgbdFrame& frame, const TrackingInput& input,
                                   FrameResult& result, StageClock& clock) {
  move_to(result.tracking, input);
  result.slices_left = map_.follow(camera());
  map_.bring_back_visible(input.surface_C, camera());
  clock.end_of(&StageTimes::shift_ms);
  integrator_.integrate(frame, X_WC_, map_.volume(), noise_.noise());
  clock.end_of(&StageTimes::integrate_ms);
  update_model(frame, input, result.tracking);
  clock.end_of(&StageTimes::raycast_ms);
}

std::vector<CloudSlice> MapperPipeline::finish() {
  if (loops_) {
    map_.send(guests_.take_in(*loops_, utime_, SIZE_MAX), camera());
    correct(loops_->finish());
  }
  return map_.finish(camera());
}

std::optional<KeyframeMessage> MapperPipeline::take_keyframe() {
  const auto added = loops_ ? loops_->take_new() : std::nullopt;
  if (!added) return std::nullopt;
  const auto previous = std::exchange(told_keyframe_, added->number);
  return keyframe_message(*added, previous, map_.part(), utime_, map_.volume().resolution_m());
}

std::map<int, Trajectory> MapperPipeline::corrected_paths() const {
  return loops_ ? loops_->corrected_paths() : paths_;
}

/// Whether what the frame shows determines how a camera moves: registers it with itself.
bool MapperPipeline::can_be_tracked_in(const TrackingInput& input) const {
  const Model model{input.surface_C, Pose::Identity(), config_.volume.resolution_m};
  Tracker tracker(config_.tracker);
  tracker.start_at(model.X_WV, input,
                   covered_share(input.surface_C.front(), model.X_WV, Model().region_W));
  return is_located(tracker.track(input, model).state);
}

/// The camera has been lost for long: what it sees from now on has a place of its own in W.
PartBegun MapperPipeline::begin_part(TrackingResult lost) {
  map_.begin_part(loops_ ? loops_->next_part() : map_.part() + 1, camera());
  if (loops_) loops_->begin_part();
  X_WC_ = origin_of_part(map_.part());
  tracker_ = Tracker(config_.tracker);  // how much of its view the camera saw before says nothing
  model_.reset();
  return {.part = map_.part(), .lost = std::move(lost)};
}

/// Moves the patches; returns what it was given.
std::optional<MapCorrection> MapperPipeline::correct(std::optional<MapCorrection> correction) {
  if (correction) map_.send_correction(camera());
  return correction;
}

RgbdFrame MapperPipeline::cleaned(const RgbdFrame& frame) {
  check_image_size("depth_m", frame.depth_m.size(), frame.intrinsics);
  if (!has_frames_ && !config_.noise) noise_ = NoiseEstimator(typical_noise(frame.intrinsics));
  has_frames_ = true;
  local_noise_.add(frame.depth_m);
  RgbdFrame clean = frame;
  clean.depth_m = without_mixed_pixels(frame.depth_m, frame.intrinsics, local_noise_.noise());
  if (config_.limit_range_by_noise) {
    const double range_m = range_of(noise_.noise(), map_.volume().max_truncation_m());
    clean.depth_m.setTo(std::numeric_limits<float>::quiet_NaN(), clean.depth_m > range_m);
  }
  return clean;
}

TrackingInput MapperPipeline::prepare(const RgbdFrame& frame) const {
  if (!config_.given_path.empty()) return {frame.utime, {}, frame.color_rgb};
  const auto num_levels = static_cast<int>(config_.tracker.registration.iterations.size());
  const int least_px = 1 << (halvings(frame.intrinsics) + num_levels - 1);
  require(frame.intrinsics.width >= least_px && frame.intrinsics.height >= least_px,
          "images of " + std::to_string(frame.intrinsics.width) + "x" +
              std::to_string(frame.intrinsics.height) + " pixels are too small: tracking needs " +
              std::to_string(least_px) + " along each side");
  return {frame.utime,
          pyramid_from_depth(frame.depth_m, frame.intrinsics, halvings(frame.intrinsics),
                             num_levels, static_cast<float>(config_.integrator.max_depth_m),
                             {noise_.noise(), local_noise_.noise()}),
          frame.color_rgb};
}

TrackingResult MapperPipeline::locate(const TrackingInput& input) {
  if (!config_.given_path.empty()) return locate_on_given_path(input.utime);
  if (!model_) return start(input);
  TrackingResult result = tracker_.track(input, *model_);
  if (result.state == TrackingState::kLost) {
    if (const auto found = find_again(input)) result = *found;
  } else {
    learn_noise(input, result.X_WC);
  }
  return result;
}

TrackingResult MapperPipeline::locate_on_given_path(std::int64_t utime) const {
  TrackingResult result;
  const auto X_WC = pose_at(config_.given_path, utime);
  result.state = X_WC ? TrackingState::kGiven : TrackingState::kLost;
  result.X_WC = X_WC.value_or(X_WC_);
  return result;
}

TrackingResult MapperPipeline::start(const TrackingInput& input) {
  TrackingResult result;  // kStarting
  result.X_WC = origin_of_part(map_.part());
  const double covered = covered_share(input.surface_C.front(), result.X_WC, map_.region_U());
  result.quality.covered_share = covered;
  if (covered >= config_.tracker.loss.min_covered_share) {
    tracker_.start_at(result.X_WC, input, covered);
    result.state = TrackingState::kTracking;
  }
  return result;
}

void MapperPipeline::learn_noise(const TrackingInput& input, const Pose& X_WC) {
  if (!config_.learn_noise) return;
  const std::size_t level = std::min<std::size_t>(1, input.surface_C.size() - 1);
  noise_.add(input.surface_C[level], model_->surface_V[level], model_->X_WV.inverse() * X_WC);
}

std::optional<TrackingResult> MapperPipeline::find_again(const TrackingInput& input) {
  const SurfaceMap& surface_C = input.surface_C.front();
  const auto model_from_pose = [&](const Pose& X_WV) {
    return model_from(X_WV, surface_C.intrinsics, surface_C.depth_m);
  };
  Relocalizer::PlaceOf place_of;
  if (loops_) {
    place_of = [this, ways_m = loops_->ways_m()](int keyframe) -> Relocalizer::Place {
      return {.motion = map_.camera_at().place.X_WU.inverse(Eigen::Isometry) *
                        map_.place_of(keyframe).X_WU,
              .way_m = ways_m[keyframe]};
    };
  }
  auto found = relocalizer_.find(input, tracker_, model_from_pose, place_of);
  if (found) tracker_.start_at(found->X_WC, input, found->quality.covered_share);
  return found;
}

/// Also to surface that has left, where one of its keyframes has found the camera.
void MapperPipeline::move_to(const TrackingResult& located, const TrackingInput& input) {
  const auto keyframe = located.found_by_keyframe;
  if (keyframe && map_.keeps_what_left() && relocalizer_.keyframes().is_released()[*keyframe]) {
    go_over_to(*keyframe, located.X_WC, input);
  }
  X_WC_ = located.X_WC;
}

void MapperPipeline::update_model(const RgbdFrame& frame, const TrackingInput& input,
                                  TrackingResult& located) {
  if (!config_.given_path.empty()) {  // the model is only for tracking
    follow(located, false, input.utime);
    return;
  }
  if (loops_) loops_->release_left(map_.volume(), X_WC_);
  if (map_.keeps_what_left()) {
    loops_->take_back(map_.volume(), X_WC_);
    if (go_over_to_known_surface(input)) {
      located.X_WC = X_WC_;
      located.found_by_keyframe.reset();  // the pose is in another frame by now
    }
  }
  model_ = model_from(X_WC_, input.surface_C.front().intrinsics, frame.depth_m);
  follow(located, relocalizer_.remember(input, *model_), input.utime);
}

/// Adds the camera's pose to its path.
void MapperPipeline::follow(const TrackingResult& located, bool is_keyframe, std::int64_t utime) {
  if (loops_) {
    loops_->follow(located, is_keyframe, utime, noise_.noise());
  } else {
    paths_[map_.part()].push_back({utime, X_WC_});
  }
}

/// Where a keyframe would be due but is there already, and its surface is kept: the frame is
/// registered with that, and tracking goes on there.
bool MapperPipeline::go_over_to_known_surface(const TrackingInput& input) {
  if (relocalizer_.keyframes().find_near(X_WC_)) return false;
  const Pose X_CorrectedC = map_.camera_at().place.X_WU * X_WC_;
  const auto number = loops_->find_released_near(X_CorrectedC);
  if (!number) return false;
  const Keyframe& keyframe = relocalizer_.keyframes()[*number];
  if (!map_.keeps_most_of(keyframe, loops_->keyframes_near(*number))) return false;
  const Pose X_NC_expected =
      loops_->deformation().at(*number).inverse(Eigen::Isometry) * X_CorrectedC;
  const Model seen_then{
      pyramid_from_surface(keyframe.surface(), static_cast<int>(input.surface_C.size())),
      keyframe.X_WC, config_.volume.resolution_m};
  const TrackingResult found = tracker_.register_anew(input, seen_then, X_NC_expected);
  if (found.state != TrackingState::kTracking) return false;
  const Pose difference = X_NC_expected.inverse(Eigen::Isometry) * found.X_WC;
  const double limit_m =
      config_.same_surface.max_distance_vox * config_.volume.resolution_m +
      config_.loops.closer.verifier.max_disagreement_sigmas * found.quality.sigma_m;
  if (motion_size(difference) > limit_m) return false;
  if (motion_size(difference) > config_.volume.resolution_m) {
    loops_->measure_anew(*number, found, X_WC_, input.utime);
  }
  tracker_.change_frame(found.X_WC * X_WC_.inverse(Eigen::Isometry));
  go_over_to(*number, found.X_WC, input);
  return true;
}

/// Goes to where a keyframe is, in whose frame N the camera is from now on.
void MapperPipeline::go_over_to(int keyframe, const Pose& X_NC, const TrackingInput& input) {
  map_.leave(camera());
  X_WC_ = X_NC;
  loops_->go_to(keyframe);
  map_.arrive(keyframe, input.surface_C, camera());
  loops_->take_back(map_.volume(), X_NC);
}

void MapperPipeline::look_where_expected(const TrackingInput& input) {
  const Pose X_WV = tracker_.predict(input.utime);
  if (X_WV.matrix() == model_->X_WV.matrix()) return;
  model_ = model_from(X_WV, input.surface_C.front().intrinsics, {});
}

Model MapperPipeline::model_from(const Pose& X_WV, const Intrinsics& camera,
                                 const cv::Mat_<float>& guide_depth_m) const {
  return {pyramid_from_surface(raycaster_.raycast(map_.volume(), X_WV, camera, guide_depth_m),
                               static_cast<int>(config_.tracker.registration.iterations.size())),
          X_WV, config_.volume.resolution_m, map_.region_U()};
}

int MapperPipeline::halvings(const Intrinsics& intrinsics) const {
  int count = 0;
  while ((intrinsics.width >> (count + 1)) >= config_.finest_tracking_width_px) ++count;
  return count;
}

}  // namespace kintsugi::mapper
