#include "mapper/core/mapper_pipeline.hpp"

#include <iterator>
#include <utility>

#include "mapper/core/check.hpp"
#include "mapper/core/covered_share.hpp"

namespace kintsugi::mapper {
namespace {

Eigen::AlignedBox3d region_of(const TsdfVolume& volume) {
  const double half_side_m = 0.5 * volume.side_blocks() * kBlockSide * volume.config().resolution_m;
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(half_side_m);
  return {volume.center_W() - reach, volume.center_W() + reach};
}

bool is_located(TrackingState state) {
  return state == TrackingState::kTracking || state == TrackingState::kGiven;
}

}  // namespace

void MapperPipeline::Config::validate() const {
  volume.validate();
  integrator.validate();
  raycaster.validate();
  tracker.validate();
  slices.validate();
  check_range("finest_tracking_width_px", finest_tracking_width_px, 16, 16384);
}

MapperPipeline::MapperPipeline(const Config& config)
    : config_((config.validate(), config)),
      volume_(config.volume),
      integrator_(config.integrator),
      raycaster_(config.raycaster),
      tracker_(config.tracker),
      slice_worker_(config.slices) {}

FrameResult MapperPipeline::process(const RgbdFrame& frame) {
  FrameResult result;
  StageClock clock;
  utime_ = frame.utime;
  result.tracking = locate(frame, clock);
  clock.end_of(&StageTimes::track_ms);
  if (is_located(result.tracking.state)) {
    X_WC_ = result.tracking.X_WC;
    result.slices_left = shift(frame, X_WC_);
    clock.end_of(&StageTimes::shift_ms);
    integrator_.integrate(frame, X_WC_, volume_);
    clock.end_of(&StageTimes::integrate_ms);
    render_model(frame, X_WC_);
    clock.end_of(&StageTimes::raycast_ms);
  }
  result.times = clock.wall();
  result.cpu_times = clock.cpu();
  result.slices = slice_worker_.take_finished();
  return result;
}

std::vector<CloudSlice> MapperPipeline::finish() {
  slice_worker_.submit(volume_.detach_all(), utime_, X_WC_);
  return slice_worker_.drain();
}

TrackingResult MapperPipeline::locate(const RgbdFrame& frame, StageClock& clock) {
  if (!config_.given_path.empty()) return locate_on_given_path(frame);
  const TrackingInput input{
      frame.utime,
      pyramid_from_depth(frame.depth_m, frame.intrinsics, halvings(frame.intrinsics),
                         static_cast<int>(config_.tracker.iterations.size()),
                         static_cast<float>(config_.integrator.max_depth_m)),
      frame.color_rgb};
  clock.end_of(&StageTimes::prepare_ms);
  return model_ ? tracker_.track(input, *model_) : start(input);
}

TrackingResult MapperPipeline::locate_on_given_path(const RgbdFrame& frame) const {
  TrackingResult result;
  const auto X_WC = pose_at(config_.given_path, frame.utime);
  result.state = X_WC ? TrackingState::kGiven : TrackingState::kLost;
  result.X_WC = X_WC.value_or(X_WC_);
  return result;
}

TrackingResult MapperPipeline::start(const TrackingInput& input) {
  TrackingResult result;  // kStarting at the identity
  const double covered = covered_share(input.surface_C.front(), result.X_WC, region_of(volume_));
  result.quality.covered_share = covered;
  if (covered >= config_.tracker.loss.min_covered_share) {
    tracker_.start_at(result.X_WC, input, covered);
    result.state = TrackingState::kTracking;
  }
  return result;
}

int MapperPipeline::shift(const RgbdFrame& frame, const Pose& X_WC) {
  std::vector<DetachedBlocks> left = volume_.shift_to(X_WC.translation());
  for (DetachedBlocks& blocks : left) slice_worker_.submit(std::move(blocks), frame.utime, X_WC);
  return static_cast<int>(left.size());
}

void MapperPipeline::render_model(const RgbdFrame& frame, const Pose& X_WC) {
  if (!config_.given_path.empty()) return;  // nothing is registered with it
  Intrinsics camera = frame.intrinsics;
  for (int i = 0; i < halvings(frame.intrinsics); ++i) camera = half_size(camera);
  SurfaceMap surface_V = raycaster_.raycast(volume_, X_WC, camera, frame.depth_m);
  model_ = Model{pyramid_from_surface(std::move(surface_V),
                                      static_cast<int>(config_.tracker.iterations.size())),
                 X_WC, region_of(volume_)};
}

int MapperPipeline::halvings(const Intrinsics& intrinsics) const {
  int count = 0;
  while ((intrinsics.width >> (count + 1)) >= config_.finest_tracking_width_px) ++count;
  return count;
}

}  // namespace kintsugi::mapper
