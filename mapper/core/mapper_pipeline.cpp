#include "mapper/core/mapper_pipeline.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <utility>

#include "lcmtypes/base/argument_check.hpp"
#include "lcmtypes/trajectory.hpp"
#include "mapper/core/frame/camera.hpp"
#include "mapper/core/frame/covered_share.hpp"
#include "mapper/core/frame/sensors.hpp"
#include "mapper/core/fusion/truncation.hpp"
#include "mapper/core/guests/keyframe_message.hpp"
#include "mapper/core/relocalization/keyframe_blocks.hpp"

namespace kintsugi::mapper {
namespace {

/// Of their keyframes, so that those of the camera are compared in time.
constexpr std::size_t kMaxGuestsWaiting = 2;
constexpr double kRaysBeyondRange = 1.2;  // the camera may have moved back from what it mapped

Eigen::AlignedBox3d region_of(const TsdfVolume& volume) {
  // The ball holds all that is measured within the range.
  if (volume.config().region == RegionShape::kBall) return Model().region_W;
  const double half_side_m = 0.5 * volume.side_blocks() * kBlockSide * volume.config().resolution_m;
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(half_side_m);
  return {volume.center_W() - reach, volume.center_W() + reach};
}

CrossingRule crossing_rule(const SurfaceExtractor::Config& config, const TsdfVolume& volume) {
  return {config.weight_threshold, config.max_step_vox, volume.resolution_m(),
          volume.max_truncation_m()};
}

LoopClosure::Config loop_config(const MapperPipeline::Config& config) {
  LoopClosure::Config loops = config.loops;
  const double voxel_m = config.volume.resolution_m;
  loops.voxel_m = voxel_m;
  loops.closer.graph.voxel_m = voxel_m;
  loops.closer.verifier.voxel_m = voxel_m;
  loops.closer.verifier.registration = config.tracker.registration;
  loops.closer.graph.max_drift_share = config.tracker.max_drift_share;
  loops.max_speed = config.tracker.max_speed;
  loops.reach_m = config.integrator.max_depth_m;
  loops.closer.graph.near_m = config.integrator.max_depth_m;
  return loops;
}

SliceWorker::Config worker_config(const MapperPipeline::Config& config, const TileGrid& tiles) {
  SliceWorker::Config worker = config.slices;
  if (config.patch_side_m > 0.0) worker.tiles = tiles;
  return worker;
}

SameSurface same_surface(const MapperPipeline::Config& config) {
  SameSurface same = config.same_surface;
  same.weight_threshold = config.slices.extractor.weight_threshold;
  return same;
}

}  // namespace

void MapperPipeline::Config::set_max_range(double max_range_m) {
  limit_range_by_noise = max_range_m == 0.0;
  if (limit_range_by_noise) {
    const double by_noise_m = range_of(noise.value_or(DepthNoise()),
                                       volume.resolution_m * volume.largest_truncation_vox());
    max_range_m = std::min({by_noise_m, TsdfVolume::longest_range_m(volume), kLongestDepth_m});
  }
  volume.max_range_m = max_range_m;
  integrator.max_depth_m = max_range_m;
  raycaster.max_depth_m = max_range_m * kRaysBeyondRange;
}

void MapperPipeline::Config::validate() const {
  volume.validate();
  integrator.validate();
  raycaster.validate();
  tracker.validate();
  relocalizer.validate();
  loops.validate();
  same_surface.validate();
  slices.validate();
  check_range("max_kept_mb", max_kept_mb, 0.0, 1e6);
  check_range("patch_side_m", patch_side_m, 0.0, 100.0);
  patch_schedule.validate();
  check_range("restart_after_s", restart_after_s, 0.0, 1e6);
  check_range("finest_tracking_width_px", finest_tracking_width_px, 16, 16384);
}

MapperPipeline::MapperPipeline(const Config& config)
    : config_((config.validate(), config)),
      volume_(config.volume),
      integrator_(config.integrator),
      raycaster_(config.raycaster),
      tracker_(config.tracker),
      noise_(config.noise.value_or(DepthNoise())),
      relocalizer_(config.relocalizer),
      guests_(config.volume.resolution_m),
      restart_rule_(config.given_path.empty() ? config.restart_after_s : 0.0),
      tiles_(config.patch_side_m, config.volume.resolution_m),
      slice_worker_(worker_config(config, tiles_)) {
  if (config.patch_side_m > 0.0) {
    if (config.close_loops && config.given_path.empty()) {
      loops_.emplace(loop_config(config), relocalizer_.keyframes());
      if (config.volume.region == RegionShape::kBall)
        reactivation_.emplace(tiles_, config.max_kept_mb);
    }
    patch_schedule_.emplace(config.patch_schedule, tiles_,
                            crossing_rule(config.slices.extractor, volume_));
  }
}

FrameResult MapperPipeline::process(const RgbdFrame& measured) {
  FrameResult result;
  StageClock clock;
  const RgbdFrame frame = cleaned(measured);
  utime_ = frame.utime;
  const TrackingInput input = prepare(frame);
  clock.end_of(&StageTimes::prepare_ms);
  result.tracking = locate(input);
  if (restart_rule_.is_due(frame.utime, result.tracking.state)) {
    result.part_begun = begin_part(std::move(result.tracking));
    result.tracking = locate(input);
  }
  clock.end_of(&StageTimes::track_ms);
  if (is_located(result.tracking.state)) {
    const auto keyframe = result.tracking.found_by_keyframe;
    if (reactivation_ && keyframe && relocalizer_.keyframes().is_released()[*keyframe]) {
      go_over_to(*keyframe, result.tracking.X_WC, input);
    }
    X_WC_ = result.tracking.X_WC;
    result.slices_left = shift(X_WC_.translation());
    if (reactivation_) {
      reactivation_->tidy(frame.utime);
      bring_back_visible(input);
    }
    clock.end_of(&StageTimes::shift_ms);
    integrator_.integrate(frame, X_WC_, volume_, noise_.noise());
    clock.end_of(&StageTimes::integrate_ms);
    update_model(frame, input, result.tracking);
    clock.end_of(&StageTimes::raycast_ms);
  } else if (model_) {
    look_where_expected(input);
    clock.end_of(&StageTimes::raycast_ms);
  }
  if (loops_) {
    result.correction = correct(loops_->take_due(frame.utime));
    result.tracking.X_WC = corrected(result.tracking.X_WC);
    clock.end_of(&StageTimes::loops_ms);
  }
  if (patch_schedule_) {
    submit_patches(frame);
    if (loops_) take_in_guests(kMaxGuestsWaiting);
    clock.end_of(&StageTimes::patches_ms);
  }
  result.part = part();
  result.times = clock.wall();
  result.cpu_times = clock.cpu();
  result.slices = slice_worker_.take_finished();
  return result;
}

std::vector<CloudSlice> MapperPipeline::finish() {
  if (loops_) {
    take_in_guests(SIZE_MAX);
    correct(loops_->finish());
  }
  if (reactivation_) clear_known(slots_of([](BlockSlot) { return true; }));
  SliceCamera camera = camera_now();
  // At the last frame a batch of patches may have ended, and one of guests' patches after it.
  if (patch_schedule_) camera.utime += 2;
  slice_worker_.submit(volume_.detach_all(), camera);
  return slice_worker_.drain();
}

std::optional<KeyframeMessage> MapperPipeline::take_keyframe() {
  const auto added = loops_ ? loops_->take_new() : std::nullopt;
  if (!added) return std::nullopt;
  const auto previous = std::exchange(told_keyframe_, added->number);
  return keyframe_message(*added, previous, part_, utime_, volume_.resolution_m());
}

std::map<int, Trajectory> MapperPipeline::corrected_paths() const {
  return loops_ ? loops_->corrected_paths() : paths_;
}

/// The camera has been lost for long: what it sees from now on has a place of its own in W, and
/// what it saw leaves the volume.
PartBegun MapperPipeline::begin_part(TrackingResult lost) {
  const int part = loops_ ? loops_->next_part() : part_ + 1;
  const Pose origin = origin_of_part(part);
  shift(origin.translation());
  volume_.center_at(origin.translation());
  if (patch_schedule_) depart_all_patches();
  part_ = part;
  if (loops_) loops_->begin_part();
  X_WC_ = origin;
  tracker_ = Tracker(config_.tracker);  // how much of its view the camera saw before says nothing
  model_.reset();
  return {.part = part_, .lost = std::move(lost)};
}

std::optional<MapCorrection> MapperPipeline::correct(std::optional<MapCorrection> correction) {
  if (!correction) return std::nullopt;
  slice_worker_.submit(loops_->deformation(), camera_now(), volume_.resolution_m());
  return correction;
}

Pose MapperPipeline::corrected(const Pose& X_UC) const { return place_of(seen_at()).X_WU * X_UC; }

/// Where what was seen at a keyframe is by now; where loops are not closed, in a part of the map.
MapDeformation::Place MapperPipeline::place_of(int seen_at) const {
  if (loops_) return loops_->deformation().place(seen_at);
  return {.X_WU = Pose::Identity(), .part = seen_at};
}

RgbdFrame MapperPipeline::cleaned(const RgbdFrame& frame) {
  check_image_size("depth_m", frame.depth_m.size(), frame.intrinsics);
  if (!has_frames_ && !config_.noise) noise_ = NoiseEstimator(typical_noise(frame.intrinsics));
  has_frames_ = true;
  local_noise_.add(frame.depth_m);
  RgbdFrame clean = frame;
  clean.depth_m = without_mixed_pixels(frame.depth_m, frame.intrinsics, local_noise_.noise());
  if (config_.limit_range_by_noise) {
    const double range_m = range_of(noise_.noise(), volume_.max_truncation_m());
    clean.depth_m.setTo(std::numeric_limits<float>::quiet_NaN(), clean.depth_m > range_m);
  }
  return clean;
}

TrackingInput MapperPipeline::prepare(const RgbdFrame& frame) const {
  if (!config_.given_path.empty()) return {frame.utime, {}, frame.color_rgb};
  return {frame.utime,
          pyramid_from_depth(frame.depth_m, frame.intrinsics, halvings(frame.intrinsics),
                             static_cast<int>(config_.tracker.registration.iterations.size()),
                             static_cast<float>(config_.integrator.max_depth_m),
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
  result.X_WC = origin_of_part(part_);
  const double covered = covered_share(input.surface_C.front(), result.X_WC, region_of(volume_));
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
  const auto motion_of = [&](int keyframe) -> Pose {
    if (!loops_) return Pose::Identity();
    return place_of(seen_at()).X_WU.inverse(Eigen::Isometry) * place_of(keyframe).X_WU;
  };
  auto found = relocalizer_.find(input, tracker_, model_from_pose, motion_of);
  if (found) tracker_.start_at(found->X_WC, input, found->quality.covered_share);
  return found;
}

int MapperPipeline::shift(const Eigen::Vector3d& camera_W) {
  TsdfVolume::BeforeLeaving before_leaving;
  if (reactivation_) before_leaving = [this](const auto& leaving) { clear_known(leaving); };
  std::vector<DetachedBlocks> left = volume_.shift_to(camera_W, before_leaving);
  for (DetachedBlocks& blocks : left) take_left(std::move(blocks));
  return static_cast<int>(left.size()) + (reactivation_ ? let_go_of_far_surface() : 0);
}

/// What the camera saw long ago, on a way on which tracking may have drifted, is not where it sees
/// it now. It leaves before the camera comes back to it.
int MapperPipeline::let_go_of_far_surface() {
  const bool is_new_keyframe =
      keyframe_at_move_.empty() || keyframe_at_move_.back() != loops_->keyframe();
  keyframe_at_move_.resize(volume_.num_moves() + 1, loops_->keyframe());
  if (!is_new_keyframe) return 0;
  const std::vector<bool> is_near = loops_->near_keyframes();
  std::vector<BlockSlot> far = slots_of([&](BlockSlot slot) {
    const auto keyframe = static_cast<std::size_t>(keyframe_at_move_[volume_.last_seen(slot)]);
    return keyframe < is_near.size() && !is_near[keyframe];
  });
  if (far.empty()) return 0;
  clear_known(far);
  std::erase_if(far, [this](BlockSlot slot) { return !volume_.in_use(slot); });
  take_left(volume_.detach(std::move(far), SliceKind::kPatch));
  return 1;
}

std::vector<BlockSlot> MapperPipeline::slots_of(
    const std::function<bool(BlockSlot)>& is_chosen) const {
  std::vector<BlockSlot> slots;
  for (BlockSlot slot = 0; slot < volume_.slots_end(); ++slot) {
    if (volume_.in_use(slot) && is_chosen(slot)) slots.push_back(slot);
  }
  return slots;
}

/// Of surface that is seen again after a long way one stays: the first one, to which the camera
/// goes over.
void MapperPipeline::clear_known(const std::vector<BlockSlot>& leaving) {
  std::vector<BlockCoord> coords;
  coords.reserve(leaving.size());
  for (const BlockSlot slot : leaving) coords.push_back(volume_.coord(slot));
  reactivation_->clear_known(volume_, leaving, places_of_far_keyframes(), same_surface(config_));
  std::erase_if(coords,
                [this](const BlockCoord& coord) { return volume_.find(coord) != kNoBlock; });
  patch_schedule_->note_left(coords, volume_);
}

Reactivation::PlaceOfKeyframe MapperPipeline::places_of_far_keyframes() const {
  return
      [this, is_near = loops_->near_keyframes(),
       X_WU = loops_->deformation().at(loops_->keyframe())](int keyframe) -> std::optional<Pose> {
        if (is_near[keyframe]) return std::nullopt;
        return loops_->deformation().at(keyframe).inverse(Eigen::Isometry) * X_WU;
      };
}

void MapperPipeline::take_left(DetachedBlocks left) {
  if (patch_schedule_) patch_schedule_->note_left(left.coords, volume_);
  if (reactivation_) reactivation_->keep(left);
  slice_worker_.submit(std::move(left), camera_now());
}

void MapperPipeline::submit_patches(const RgbdFrame& frame) {
  std::optional<PatchBatch> batch = patch_schedule_->next(volume_, frame.utime, seen_at());
  if (!batch) return;
  submit_patches(*std::move(batch));
}

/// The volume is empty, and what is seen from now on is of other patches.
void MapperPipeline::depart_all_patches() {
  submit_patches(patch_schedule_->depart_all(reactivation_ ? reactivation_->open_tiles()
                                                           : std::vector<TileCoord>()));
}

void MapperPipeline::take_in_guests(std::size_t max_waiting) {
  std::vector<GuestPatch> patches = guests_.take_in(*loops_, utime_, max_waiting);
  if (patches.empty()) return;
  SliceCamera camera = camera_now();
  ++camera.utime;  // a batch of this map's patches may have ended at this frame
  slice_worker_.submit(std::move(patches), camera, volume_.resolution_m());
}

void MapperPipeline::submit_patches(PatchBatch batch) {
  if (reactivation_) reactivation_->close_departed(batch);
  std::vector<BlockSlot> slots;
  for (PatchBatch::Patch& patch : batch.patches) {
    patch.place = place_of(patch.keyframe);
    if (!patch.in_volume) continue;
    tiles_.for_each_block(patch.tile, [&](const BlockCoord& coord) {
      const BlockSlot slot = volume_.find(coord);
      if (slot != kNoBlock) slots.push_back(slot);
    });
  }
  slice_worker_.submit(std::move(batch), volume_.snapshot(std::move(slots)), camera_now());
}

void MapperPipeline::update_model(const RgbdFrame& frame, const TrackingInput& input,
                                  TrackingResult& located) {
  if (!loops_) paths_[part_].push_back({input.utime, X_WC_});
  if (!config_.given_path.empty()) return;  // the model is only for tracking
  if (loops_) loops_->release_left(volume_, X_WC_);
  if (reactivation_) {
    loops_->take_back(volume_, X_WC_);
    if (go_over_to_known_surface(input)) located.X_WC = X_WC_;
  }
  model_ = model_from(X_WC_, input.surface_C.front().intrinsics, frame.depth_m);
  const bool is_keyframe = relocalizer_.remember(input, *model_);
  if (loops_) loops_->follow(located, is_keyframe, input.utime, noise_.noise());
}

/// What a frame at the present pose is about to change.
void MapperPipeline::bring_back_visible(const TrackingInput& input) {
  restore(reactivation_->take_visible(input.surface_C.front(), X_WC_, loops_->near_keyframes(),
                                      loops_->keyframe(), volume_));
}

void MapperPipeline::restore(const Reactivation::Returned& returned) {
  if (returned.visits.empty()) return;
  const auto& [visits_back, blocks, around] = returned;
  const auto coords_of = [](const std::vector<KeptBlock>& kept) {
    std::vector<BlockCoord> coords;
    coords.reserve(kept.size());
    for (const KeptBlock& block : kept) coords.push_back(block.coord());
    return coords;
  };
  volume_.restore(coords_of(blocks), coords_of(around),
                  [&](std::size_t i, VoxelBlock& voxels, ColorBlock& colors) {
                    const KeptBlock& block =
                        i < blocks.size() ? blocks[i] : around[i - blocks.size()];
                    block.copy_to(voxels, colors);
                  });
  std::vector<TileVisit> visits;
  for (const auto& [visit, keyframe] : visits_back) {
    patch_schedule_->note_returned(visit.tile, keyframe, volume_);
    visits.push_back(visit);
  }
  slice_worker_.submit(std::move(visits), camera_now(), volume_.resolution_m());
}

/// Where a keyframe would be due but is there already, and its surface is kept: the frame is
/// registered with that, and tracking goes on there.
bool MapperPipeline::go_over_to_known_surface(const TrackingInput& input) {
  if (relocalizer_.keyframes().find_near(X_WC_)) return false;
  const Pose X_CorrectedC = corrected(X_WC_);
  const auto number = loops_->find_released_near(X_CorrectedC);
  if (!number) return false;
  const Keyframe& keyframe = relocalizer_.keyframes()[*number];
  const std::vector<bool> is_near = loops_->keyframes_near(*number);
  if (!reactivation_->has_most_of(blocks_seen_from(keyframe, volume_.config().resolution_m),
                                  is_near)) {
    return false;
  }
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
  if (std::max(difference.translation().norm(), rotation_angle_rad(difference)) > limit_m) {
    return false;
  }
  tracker_.change_frame(found.X_WC * X_WC_.inverse(Eigen::Isometry));
  go_over_to(*number, found.X_WC, input);
  return true;
}

/// Empties the volume and fills it with what is kept around a keyframe, in whose frame N the camera
/// is from now on.
void MapperPipeline::go_over_to(int keyframe, const Pose& X_NC, const TrackingInput& input) {
  DetachedBlocks left = volume_.detach_all(SliceKind::kPatch);
  slice_worker_.submit(
      reactivation_->keep_unknown(std::move(left), config_.volume, places_of_far_keyframes(),
                                  same_surface(config_), utime_),
      camera_now());
  depart_all_patches();
  X_WC_ = X_NC;
  loops_->go_to(keyframe);
  volume_.shift_to(X_NC.translation());
  keyframe_at_move_.resize(volume_.num_moves() + 1, keyframe);
  bring_back_visible(input);
  loops_->take_back(volume_, X_NC);
}

void MapperPipeline::look_where_expected(const TrackingInput& input) {
  const Pose X_WV = tracker_.predict(input.utime);
  if (X_WV.matrix() == model_->X_WV.matrix()) return;
  model_ = model_from(X_WV, input.surface_C.front().intrinsics, {});
}

Model MapperPipeline::model_from(const Pose& X_WV, const Intrinsics& camera,
                                 const cv::Mat_<float>& guide_depth_m) const {
  return {pyramid_from_surface(raycaster_.raycast(volume_, X_WV, camera, guide_depth_m),
                               static_cast<int>(config_.tracker.registration.iterations.size())),
          X_WV, config_.volume.resolution_m, region_of(volume_)};
}

int MapperPipeline::halvings(const Intrinsics& intrinsics) const {
  int count = 0;
  while ((intrinsics.width >> (count + 1)) >= config_.finest_tracking_width_px) ++count;
  return count;
}

}  // namespace kintsugi::mapper
