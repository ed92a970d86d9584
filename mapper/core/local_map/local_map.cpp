#include "mapper/core/local_map/local_map.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "lcmtypes/base/argument_check.hpp"
#include "mapper/core/loop_closure/map_part.hpp"
#include "mapper/core/registration/model.hpp"
#include "mapper/core/relocalization/keyframe_blocks.hpp"

namespace kintsugi::mapper {
namespace {

LocalMap::Config completed(LocalMap::Config config, bool closes_loops) {
  config.validate_map();
  config.same_surface.weight_threshold = config.slices.extractor.weight_threshold;
  if (config.patch_side_m > 0.0) {
    config.slices.tiles = TileGrid(config.patch_side_m, config.volume.resolution_m);
    if (closes_loops) {
      config.slices.common_surface = {config.same_surface, config.volume.resolution_m,
                                      config.keeps_own_surface};
    }
  }
  return config;
}

CrossingRule crossing_rule(const SurfaceExtractor::Config& config, const TsdfVolume& volume) {
  return {config.weight_threshold, config.max_step_vox, volume.resolution_m(),
          volume.max_truncation_m()};
}

std::vector<BlockCoord> coords_of(const std::vector<KeptBlock>& blocks) {
  std::vector<BlockCoord> coords;
  coords.reserve(blocks.size());
  for (const KeptBlock& block : blocks) coords.push_back(block.coord());
  return coords;
}

}  // namespace

void LocalMap::Config::validate_map() const {
  volume.validate();
  same_surface.validate();
  slices.validate();
  check_range("max_kept_mb", max_kept_mb, 0.0, 1e6);
  check_range("patch_side_m", patch_side_m, 0.0, 100.0);
  patch_schedule.validate();
}

LocalMap::LocalMap(const Config& config, const LoopClosure* loops)
    : config_(completed(config, loops != nullptr)),
      loops_(loops),
      volume_(config_.volume),
      tiles_(config_.patch_side_m, config_.volume.resolution_m),
      slice_worker_(config_.slices) {
  if (config_.patch_side_m == 0.0) return;
  if (loops_ != nullptr && config_.volume.region == RegionShape::kBall) {
    reactivation_.emplace(tiles_, config_.max_kept_mb);
  }
  patch_schedule_.emplace(config_.patch_schedule, tiles_,
                          crossing_rule(config_.slices.extractor, volume_));
}

Eigen::AlignedBox3d LocalMap::region_U() const {
  // The ball holds all that is measured within the range.
  if (volume_.config().region == RegionShape::kBall) return Model().region_W;
  const double half_side_m =
      0.5 * volume_.side_blocks() * kBlockSide * volume_.config().resolution_m;
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(half_side_m);
  return {volume_.center_W() - reach, volume_.center_W() + reach};
}

SeenAt LocalMap::camera_at() const {
  const int keyframe = loops_ != nullptr ? loops_->keyframe() : part_;
  return {keyframe, place_of(keyframe)};
}

MapDeformation::Place LocalMap::place_of(int keyframe) const {
  if (loops_ != nullptr) return loops_->deformation().place(keyframe);
  return {.X_WU = Pose::Identity(), .part = keyframe};
}

SliceCamera LocalMap::slice_camera(const StampedPose& camera_U) const {
  const SeenAt at = camera_at();
  return {camera_U.utime, at.place.X_WU * camera_U.X_WC, at};
}

int LocalMap::follow(const StampedPose& camera_U) {
  const int num_slices = shift(camera_U.X_WC.translation(), camera_U);
  if (reactivation_) reactivation_->tidy(camera_U.utime);
  return num_slices;
}

int LocalMap::shift(const Eigen::Vector3d& center_U, const StampedPose& camera_U) {
  TsdfVolume::BeforeLeaving before_leaving;
  if (reactivation_) before_leaving = [this](const auto& leaving) { clear_known(leaving); };
  std::vector<DetachedBlocks> left = volume_.shift_to(center_U, before_leaving);
  for (DetachedBlocks& blocks : left) take_left(std::move(blocks), camera_U);
  return static_cast<int>(left.size()) + (reactivation_ ? let_go_of_far_surface(camera_U) : 0);
}

/// What the camera saw long ago, on a way on which tracking may have drifted, is not where it sees
/// it now. It leaves before the camera comes back to it.
int LocalMap::let_go_of_far_surface(const StampedPose& camera_U) {
  const bool is_new_keyframe =
      keyframe_at_move_.empty() || keyframe_at_move_.back() != loops_->keyframe();
  keyframe_at_move_.resize(volume_.num_moves() + 1, loops_->keyframe());
  if (!is_new_keyframe) return 0;
  const std::vector<bool> is_near = loops_->near_keyframes();
  std::vector<BlockSlot> far = slots_of([&](BlockSlot slot) {
    const auto keyframe = static_cast<std::size_t>(keyframe_seen_at(slot));
    return keyframe < is_near.size() && !is_near[keyframe];
  });
  if (far.empty()) return 0;
  clear_known(far);
  std::erase_if(far, [this](BlockSlot slot) { return !volume_.in_use(slot); });
  take_left(volume_.detach(std::move(far), SliceKind::kPatch), camera_U);
  return 1;
}

std::vector<BlockSlot> LocalMap::slots_of(const std::function<bool(BlockSlot)>& is_chosen) const {
  std::vector<BlockSlot> slots;
  for (BlockSlot slot = 0; slot < volume_.slots_end(); ++slot) {
    if (volume_.in_use(slot) && is_chosen(slot)) slots.push_back(slot);
  }
  return slots;
}

/// Of surface that is seen again one stays: the first one, to which the camera goes over after a
/// long way.
void LocalMap::clear_known(const std::vector<BlockSlot>& leaving) {
  std::vector<BlockCoord> coords;
  coords.reserve(leaving.size());
  for (const BlockSlot slot : leaving) coords.push_back(volume_.coord(slot));
  reactivation_->clear_known(volume_, by_keyframe(leaving), config_.same_surface);
  std::erase_if(coords,
                [this](const BlockCoord& coord) { return volume_.find(coord) != kNoBlock; });
  patch_schedule_->note_left(coords, volume_);
}

/// The keyframe at which the camera was when it saw a block last.
int LocalMap::keyframe_seen_at(BlockSlot slot) const {
  return keyframe_at_move_[volume_.last_seen(slot)];
}

/// Where surface is in the corrected map is told by the keyframe at which it was seen, and not by
/// that at which the camera is when it leaves.
std::vector<Reactivation::SeenBlocks> LocalMap::by_keyframe(
    const std::vector<BlockSlot>& slots) const {
  std::map<int, std::vector<BlockCoord>> coords;
  for (const BlockSlot slot : slots) coords[keyframe_seen_at(slot)].push_back(volume_.coord(slot));
  std::vector<Reactivation::SeenBlocks> seen;
  seen.reserve(coords.size());
  for (auto& [keyframe, of_keyframe] : coords) {
    seen.push_back({std::move(of_keyframe), places_of_keyframes_far_from(keyframe)});
  }
  return seen;
}

/// By keyframe: where what it saw is compared with what was seen at this one; nothing for a near
/// one.
Reactivation::PlaceOfKeyframe LocalMap::places_of_keyframes_far_from(int keyframe) const {
  return [this, is_near = loops_->keyframes_near(keyframe),
          X_WU = loops_->deformation().at(keyframe)](int other) -> std::optional<Pose> {
    if (is_near[other]) return std::nullopt;
    return loops_->deformation().at(other).inverse(Eigen::Isometry) * X_WU;
  };
}

void LocalMap::take_left(DetachedBlocks left, const StampedPose& camera_U) {
  if (patch_schedule_) patch_schedule_->note_left(left.coords, volume_);
  if (reactivation_) reactivation_->keep(left);
  slice_worker_.submit(std::move(left), slice_camera(camera_U));
}

void LocalMap::bring_back_visible(const SurfacePyramid& seen_C, const StampedPose& camera_U) {
  if (!reactivation_) return;
  restore(reactivation_->take_visible(
              seen_C.front(), camera_U.X_WC, loops_->near_keyframes(), loops_->keyframe(), volume_,
              [this](const TileCoord& tile) { return patch_schedule_->has_surface(tile); }),
          camera_U);
}

void LocalMap::restore(const Reactivation::Returned& returned, const StampedPose& camera_U) {
  if (returned.visits.empty()) return;
  const auto& [visits_back, blocks, around] = returned;
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
  slice_worker_.submit(std::move(visits), slice_camera(camera_U), volume_.resolution_m());
}

bool LocalMap::keeps_most_of(const Keyframe& keyframe, const std::vector<bool>& is_near) {
  return reactivation_->has_most_of(blocks_seen_from(keyframe, config_.volume.resolution_m),
                                    is_near);
}

void LocalMap::leave(const StampedPose& camera_U) {
  const auto seen = by_keyframe(slots_of([](BlockSlot) { return true; }));
  slice_worker_.submit(
      reactivation_->keep_unknown(volume_.detach_all(SliceKind::kPatch), config_.volume, seen,
                                  config_.same_surface, camera_U.utime),
      slice_camera(camera_U));
  depart_all(camera_U);
}

void LocalMap::arrive(int keyframe, const SurfacePyramid& seen_C, const StampedPose& camera_U) {
  volume_.shift_to(camera_U.X_WC.translation());
  keyframe_at_move_.resize(volume_.num_moves() + 1, keyframe);
  bring_back_visible(seen_C, camera_U);
}

void LocalMap::begin_part(int part, const StampedPose& camera_U) {
  const Eigen::Vector3d origin_U = origin_of_part(part).translation();
  shift(origin_U, camera_U);
  volume_.center_at(origin_U);
  depart_all(camera_U);
  part_ = part;
}

/// The volume is empty, and what is seen from now on is of other patches.
void LocalMap::depart_all(const StampedPose& camera_U) {
  if (!patch_schedule_) return;
  send(patch_schedule_->depart_all(reactivation_ ? reactivation_->open_tiles()
                                                 : std::vector<TileCoord>()),
       camera_U);
}

void LocalMap::send_due(const StampedPose& camera_U) {
  if (!patch_schedule_) return;
  auto batch = patch_schedule_->next(volume_, camera_U.utime, camera_at().keyframe);
  if (batch) send(*std::move(batch), camera_U);
}

void LocalMap::send(PatchBatch batch, const StampedPose& camera_U) {
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
  slice_worker_.submit(std::move(batch), volume_.snapshot(std::move(slots)),
                       slice_camera(camera_U));
}

void LocalMap::send(std::vector<GuestPatch> patches, const StampedPose& camera_U) {
  if (patches.empty()) return;
  SliceCamera camera = slice_camera(camera_U);
  ++camera.utime;  // a batch of this map's patches may have ended at this frame
  slice_worker_.submit(std::move(patches), camera, volume_.resolution_m());
}

void LocalMap::send_correction(const StampedPose& camera_U) {
  slice_worker_.submit(loops_->deformation(), slice_camera(camera_U), volume_.resolution_m());
}

std::vector<CloudSlice> LocalMap::finish(const StampedPose& camera_U) {
  if (reactivation_) clear_known(slots_of([](BlockSlot) { return true; }));
  SliceCamera camera = slice_camera(camera_U);
  // At the last frame a batch of patches may have ended, and one of guests' patches after it.
  if (patch_schedule_) camera.utime += 2;
  slice_worker_.submit(volume_.detach_all(), camera);
  return slice_worker_.drain();
}

}  // namespace kintsugi::mapper
