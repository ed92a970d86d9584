#include "mapper/core/guests/guest_map.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "lcmtypes/base/text_format.hpp"
#include "mapper/core/guests/keyframe_message.hpp"
#include "mapper/core/loop_closure/map_part.hpp"

namespace kintsugi::mapper {

void GuestMap::add(KeyframeMessage keyframe) {
  if (!problem_.empty()) return;
  // Both are sent as floats.
  if (keyframe.resolution_m != static_cast<float>(resolution_m_)) {
    problem_ = format("its voxels are %.2f mm, those of this map %.2f mm (--resolution)",
                      1e3 * keyframe.resolution_m, 1e3 * resolution_m_);
    return;
  }
  if (keyframe.previous < last_) return;
  const int previous = keyframe.previous;
  waiting_keyframes_.insert_or_assign(previous, std::move(keyframe));
}

void GuestMap::add(CloudSlice slice) {
  constexpr int kNotOfCamera = -1;
  const bool is_own_patch = slice.kind == SliceKind::kPatch && slice.keyframe != kNotOfCamera;
  if (!problem_.empty() || !is_own_patch || slice.superseded) return;
  const auto [newest, is_new] = newest_revision_.try_emplace(slice.id, slice.revision);
  if (!is_new && slice.revision <= newest->second) return;
  newest->second = slice.revision;
  waiting_patches_.insert_or_assign(slice.id, std::move(slice));
}

std::vector<GuestPatch> GuestMap::take_in(LoopClosure& loops, std::int64_t utime,
                                          std::size_t max_waiting) {
  while (problem_.empty() && waiting_keyframes_.contains(last_) &&
         loops.can_take_guest(max_waiting)) {
    add_next(loops, utime);
  }
  std::vector<GuestPatch> patches;
  for (auto waiting = waiting_patches_.begin(); waiting != waiting_patches_.end();) {
    CloudSlice& slice = waiting->second;
    const auto keyframe = here(slice.keyframe);
    if (!keyframe) {
      ++waiting;
      continue;
    }
    patches.push_back({.name = {slice.session, slice.id},
                       .at = {*keyframe, loops.deformation().place(*keyframe)},
                       .X_UP = X_UG(part_of_.at(slice.keyframe)),
                       .in_volume = slice.in_volume,
                       .points_P = std::move(slice.points_W)});
    waiting = waiting_patches_.erase(waiting);
  }
  return patches;
}

void GuestMap::add_next(LoopClosure& loops, std::int64_t utime) {
  const KeyframeMessage message = std::move(waiting_keyframes_.extract(last_).mapped());
  const auto from = here(message.tracked_from);
  auto keyframe = keyframe_of(message);
  if (!keyframe || (message.tracked_from >= 0 && !from)) {
    problem_ = keyframe ? format("its keyframe %d follows one that was not sent", message.number)
                        : format("its keyframe %d has %d x %d pixels", message.number,
                                 message.intrinsics.width, message.intrinsics.height);
    return;
  }
  if (!from) part_here_[message.part] = loops.next_part();
  part_of_[message.number] = from ? part_of_.at(message.tracked_from) : message.part;
  keyframe->X_WC = X_UG(part_of_.at(message.number)) * message.X_UK;

  NewKeyframe added;
  added.from = from;
  added.way_m = message.way_m;
  if (!from && last_ >= 0) {
    added.unseen = UnseenWay{.before = number_here_.at(last_), .distance_m = message.unseen_m};
  }
  added.information = message.information_K;
  added.noise = {.base_m = message.noise_base_m,
                 .share = message.noise_share,
                 .growth_per_m = message.noise_growth_per_m};
  for (const int number : message.in_volume) {
    const auto in_volume = here(number);
    if (!in_volume) continue;
    added.is_released.resize(std::max<std::size_t>(added.is_released.size(), *in_volume + 1), true);
    added.is_released[*in_volume] = false;
  }
  number_here_[message.number] = loops.add_guest(std::move(added), std::move(keyframe), utime);
  last_ = message.number;
}

/// The place of the guest's uncorrected map G in that of this one: beside it, in a part of its own.
Pose GuestMap::X_UG(int part_of_guest) const {
  return origin_of_part(part_here_.at(part_of_guest)) *
         origin_of_part(part_of_guest).inverse(Eigen::Isometry);
}

std::optional<int> GuestMap::here(int number) const {
  const auto found = number_here_.find(number);
  return found == number_here_.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace kintsugi::mapper
