#include "mapper/core/loop_closure/loop_closure.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "lcmtypes/base/argument_check.hpp"
#include "lcmtypes/trajectory.hpp"
#include "mapper/core/relocalization/keyframe_blocks.hpp"

namespace kintsugi::mapper {
namespace {

/// Whether most of what it saw is not in the volume any more.
bool has_left(const Keyframe& keyframe, const TsdfVolume& volume) {
  const std::vector<BlockCoord> blocks = blocks_seen_from(keyframe, volume.config().resolution_m);
  const auto num_there = std::ranges::count_if(
      blocks, [&](const BlockCoord& block) { return volume.find(block) != kNoBlock; });
  return 2 * static_cast<std::size_t>(num_there) < blocks.size();
}

std::vector<MapDeformation::PartLoop> links_of(const MapCorrection& correction) {
  std::vector<MapDeformation::PartLoop> links;
  links.reserve(correction.loops.size());
  for (const Loop& loop : correction.loops) {
    MapDeformation::PartLoop& added = links.emplace_back();
    added.part = correction.parts[loop.earlier];
    added.link.later = loop.later;
    added.link.earlier = loop.earlier;
    Eigen::Map<Eigen::Vector3f>(added.link.later_W) =
        correction.X_WK[loop.later].translation().cast<float>();
    Eigen::Map<Eigen::Vector3f>(added.link.earlier_W) =
        correction.X_WK[loop.earlier].translation().cast<float>();
  }
  return links;
}

}  // namespace

void LoopClosure::Config::validate() const {
  closer.validate();
  check_range("period_s", period_s, 0.0, 1e6);
  check_range("large_motion_vox", large_motion_vox, 0.0, 1e3);
  check_range("least_motion_vox", least_motion_vox, 0.0, 1e3);
  check_range("reach_m", reach_m, 0.0, 1e3);
  check_range("voxel_m", voxel_m, 1e-4, 1.0);
  check_range("appearance_s", appearance_s, 0.0, closer.delay_s);
  check_range("max_speed", max_speed, 0.0, 1e6);
  check_range("max_similar", max_similar, 0, 1000);
}

LoopClosure::LoopClosure(const Config& config, KeyframeMap& keyframes)
    : config_((config.validate(), config)), keyframes_(keyframes), closer_(config.closer) {
  begin_part();
}

int LoopClosure::begin_part() {
  if (begins_part_) return num_begun_ - 1;
  if (newest_number_ >= 0) {
    lost_utime_ = last_utime_;
    const Eigen::Vector3d last_position_W = deformation_.at(last_at_) * last_position_U_;
    lost_at_m_ = (X_WK(newest_number_).translation() - last_position_W).norm();
  }
  keyframes_.release_if([](const Keyframe&) { return true; });
  last_at_ = keyframes_.size();
  begins_part_ = true;
  deformation_.add({.X_WU = Pose::Identity(), .part = num_begun_++});
  return num_begun_ - 1;
}

int LoopClosure::num_parts() const {
  std::set<int> parts;
  for (int k = 0; k < deformation_.size(); ++k) parts.insert(deformation_.part_of(k));
  return static_cast<int>(parts.size());
}

void LoopClosure::release_left(const TsdfVolume& volume, const Pose& X_UC) {
  const auto near = keyframes_.find_near(X_UC);
  if (near && !has_left(keyframes_[*near], volume)) return;
  keyframes_.release_if([&](const Keyframe& keyframe) { return has_left(keyframe, volume); });
}

void LoopClosure::take_back(const TsdfVolume& volume, const Pose& X_UC) {
  if (keyframes_.find_near(X_UC)) return;
  const std::vector<bool> is_near = near_keyframes();
  for (int i = 0; i < keyframes_.size(); ++i) {
    if (keyframes_.is_released()[i] && is_near[i] && !has_left(keyframes_[i], volume)) {
      keyframes_.take_back(i);
    }
  }
}

std::optional<int> LoopClosure::find_released_near(const Pose& X_WC) const {
  std::optional<int> nearest;
  double least = 1.0;
  for (int i = 0; i < keyframes_.size(); ++i) {
    if (!keyframes_.is_released()[i] || keyframes_.is_guest(i)) continue;
    const double distance = keyframes_.in_spacings(X_WK(i), X_WC);
    if (!(distance < least)) continue;
    least = distance;
    nearest = i;
  }
  return nearest;
}

std::vector<double> LoopClosure::ways_m() const {
  std::vector<double> ways_m(keyframes_.size(), path_.length_m());
  if (last_at_ >= tree_.size()) return ways_m;  // a part begins
  std::vector<std::pair<int, int>> joins;
  for (const MapDeformation::PartLoop& loop : deformation_.loops()) {
    joins.emplace_back(loop.link.later, loop.link.earlier);
  }
  const std::vector<double> in_tree_m = tree_.ways_m(last_at_, joins);
  for (std::size_t i = 0; i < in_tree_m.size(); ++i) ways_m[i] = std::min(ways_m[i], in_tree_m[i]);
  return ways_m;
}

void LoopClosure::go_to(int keyframe) {
  keyframes_.release_if([](const Keyframe&) { return true; });
  last_at_ = keyframe;
  went_ = true;
}

void LoopClosure::measure_anew(int keyframe, const TrackingResult& found, const Pose& X_UC,
                               std::int64_t utime) {
  compare_newest();
  closer_.add(SharedView{.tracked_near = last_at_,
                         .X_TC = keyframes_[last_at_].X_WC.inverse(Eigen::Isometry) * X_UC,
                         .found_by = keyframe,
                         .X_FC = keyframes_[keyframe].X_WC.inverse(Eigen::Isometry) * found.X_WC,
                         .information_C = found.information_C,
                         .sigma_m = found.quality.sigma_m},
              utime);
}

void LoopClosure::follow(const TrackingResult& located, bool is_keyframe, std::int64_t utime,
                         const DepthNoise& noise) {
  const Pose& X_UC = located.X_WC;
  const bool jumped =
      std::exchange(went_, false) || begins_part_ || located.found_by_keyframe.has_value();
  if (located.found_by_keyframe) last_at_ = *located.found_by_keyframe;
  if (jumped && !begins_part_) note_near(last_at_, X_UC);
  last_utime_ = utime;
  last_position_U_ = X_UC.translation();
  if (is_keyframe) {
    compare_newest();
    const int number = keyframes_.size() - 1;
    path_.add(utime, X_UC, number, jumped);
    const bool begins_part = std::exchange(begins_part_, false);
    const auto from = begins_part ? std::nullopt : std::optional(last_at_);
    newest_ =
        NewKeyframe{.number = number,
                    .keyframe = keyframes_.share(number),
                    .from = from,
                    .way_m = from ? way_at_last_m_ + path_.length_m() - length_at_last_m_ : 0.0,
                    .unseen = begins_part ? unseen_way(utime) : std::nullopt,
                    .information = located.information_C,
                    .similar = {},
                    .is_released = keyframes_.is_released(),
                    .noise = noise};
    newest_utime_ = utime;
    newest_number_ = number;
    untold_ = newest_;
    tree_.add(from,
              from ? (keyframes_[*from].X_WC.translation() - X_UC.translation()).norm() : 0.0);
    if (from) deformation_.add(deformation_.place(*from));
    note_near(number, X_UC);
    return;
  }
  const auto near = keyframes_.find_near(X_UC);
  path_.add(utime, X_UC, near.value_or(last_at_), jumped);
  if (near) note_near(*near, X_UC);
}

void LoopClosure::note_near(int keyframe, const Pose& X_UC) {
  last_at_ = keyframe;
  way_at_last_m_ = (keyframes_[keyframe].X_WC.translation() - X_UC.translation()).norm();
  length_at_last_m_ = path_.length_m();
}

/// From the newest keyframe to where the camera was seen last, and from there as far as it can have
/// gone. On known surface there may have been no new keyframe for hours.
std::optional<UnseenWay> LoopClosure::unseen_way(std::int64_t utime) const {
  if (newest_number_ < 0) return std::nullopt;
  return UnseenWay{.before = newest_number_,
                   .distance_m = lost_at_m_ + config_.max_speed * 1e-6 *
                                                  static_cast<double>(utime - lost_utime_)};
}

std::optional<NewKeyframe> LoopClosure::take_new() {
  if (untold_) keyframes_.finish_last();
  return std::exchange(untold_, std::nullopt);
}

bool LoopClosure::can_take_guest(std::size_t max_waiting) const {
  return !begins_part_ && closer_.num_queued() < max_waiting;
}

int LoopClosure::add_guest(NewKeyframe guest, std::shared_ptr<Keyframe> keyframe,
                           std::int64_t utime) {
  compare_newest();
  const Eigen::Vector3d position_U = keyframe->X_WC.translation();
  keyframes_.add_guest(std::move(keyframe));
  guest.number = keyframes_.size() - 1;
  guest.keyframe = keyframes_.share(guest.number);
  guest.is_released.resize(keyframes_.size(), true);
  guest.similar = similar_to(guest);
  if (guest.from) {
    tree_.add(guest.from, (keyframes_[*guest.from].X_WC.translation() - position_U).norm());
    deformation_.add(deformation_.place(*guest.from));
  } else {
    tree_.add(std::nullopt, 0.0);
    deformation_.add({.X_WU = Pose::Identity(), .part = num_begun_++});
  }
  const int number = guest.number;
  closer_.add(std::move(guest), utime);
  return number;
}

void LoopClosure::compare_newest() {
  if (!newest_) return;
  NewKeyframe added = *std::exchange(newest_, std::nullopt);
  added.similar = similar_to(added);
  closer_.add(std::move(added), newest_utime_);
}

/// The keyframes before it that look like it, of those whose surface was not in the volume.
std::vector<int> LoopClosure::similar_to(const NewKeyframe& added) {
  std::vector<int> similar = keyframes_.similar_to(
      added.number, [&](int number) { return number < added.number && added.is_released[number]; });
  if (similar.size() > static_cast<std::size_t>(config_.max_similar)) {
    similar.resize(config_.max_similar);
  }
  return similar;
}

std::optional<MapCorrection> LoopClosure::take_due(std::int64_t utime) {
  if (1e-6 * static_cast<double>(utime - newest_utime_) >= config_.appearance_s) compare_newest();
  note(closer_.take_due(utime));
  if (!waiting_) return std::nullopt;
  const bool may_be_small = 1e-6 * static_cast<double>(utime - applied_utime_) >= config_.period_s;
  auto correction =
      apply_if_above(may_be_small ? config_.least_motion_vox : config_.large_motion_vox);
  if (correction) applied_utime_ = utime;
  return correction;
}

void LoopClosure::note(std::optional<MapCorrection> newest) {
  if (!newest) return;
  num_loops_ = static_cast<int>(newest->loops.size());
  num_contradicted_ = newest->num_contradicted;
  waiting_ = std::move(newest);
}

std::optional<MapCorrection> LoopClosure::finish() {
  compare_newest();
  note(closer_.drain());
  return apply_if_above(config_.least_motion_vox);
}

std::optional<MapCorrection> LoopClosure::apply_if_above(double least_motion_vox) {
  if (!waiting_ || motion_m(*waiting_) <= least_motion_vox * config_.voxel_m) return std::nullopt;
  std::vector<MapDeformation::Place> places;
  for (int k = 0; k < deformation_.size(); ++k) {
    const auto known = static_cast<std::size_t>(k);
    if (known < waiting_->X_WK.size()) {
      const Pose X_WU = waiting_->X_WK[known] * keyframes_[k].X_WC.inverse(Eigen::Isometry);
      places.push_back({X_WU, waiting_->parts[known]});
    } else if (k < tree_.size() && tree_.from(k) != k) {
      places.push_back(MapDeformation::Place(places[tree_.from(k)]));
    } else {  // it begins a part
      places.push_back(deformation_.place(k));
    }
  }
  deformation_ = MapDeformation(deformation_.number() + 1, std::move(places), links_of(*waiting_));
  return std::exchange(waiting_, std::nullopt);
}

/// The largest distance that surface of a keyframe would move.
double LoopClosure::motion_m(const MapCorrection& correction) const {
  double largest_m = 0.0;
  for (std::size_t k = 0; k < correction.X_WK.size(); ++k) {
    const int number = static_cast<int>(k);
    const Pose X_WK_before = deformation_.at(number) * keyframes_[number].X_WC;
    const Pose moved = X_WK_before.inverse(Eigen::Isometry) * correction.X_WK[k];
    largest_m = std::max(largest_m,
                         moved.translation().norm() + config_.reach_m * rotation_angle_rad(moved));
  }
  return largest_m;
}

}  // namespace kintsugi::mapper
