#include "viewer/core/scene/camera_track.hpp"

#include <algorithm>

namespace kintsugi::viewer {

bool HeardPoses::add(const CameraPose& pose) {
  if (!is_located(pose.state)) return false;
  if (newest_ && pose.utime <= newest_->utime) return false;
  if (heard_.empty() || pose.utime - heard_.back().last_utime > kMaxPause_us) {
    heard_.push_back({pose.utime, pose.utime});
  }
  heard_.back().last_utime = pose.utime;
  newest_ = TimedPose{pose.utime, pose.X_WC};
  const Eigen::Vector3f position_W = pose.X_WC.translation().cast<float>();
  if (positions_.empty() || (position_W - positions_.back().position_W).norm() >= kStep_m) {
    positions_.push_back({pose.utime, position_W});
  }
  return true;
}

bool HeardPoses::heard_at(std::int64_t utime) const {
  const auto after = std::ranges::upper_bound(heard_, utime, {}, &Interval::first_utime);
  return after != heard_.begin() && utime <= std::prev(after)->last_utime;
}

CameraTrack HeardPoses::track(const std::vector<TimedPose>& known) const {
  CameraTrack track;
  track.path_W.reserve(positions_.size() + known.size());
  auto heard = positions_.begin();
  for (const TimedPose& pose : known) {
    if (heard_at(pose.utime)) continue;
    for (; heard != positions_.end() && heard->utime < pose.utime; ++heard) {
      track.path_W.push_back(heard->position_W);
    }
    track.path_W.emplace_back(pose.X_WC.translation().cast<float>());
  }
  for (; heard != positions_.end(); ++heard) track.path_W.push_back(heard->position_W);

  const bool is_known_later = !known.empty() && (!newest_ || known.back().utime > newest_->utime);
  if (is_known_later) {
    track.X_WC = known.back().X_WC;
  } else if (newest_) {
    track.X_WC = newest_->X_WC;
  }
  return track;
}

std::int64_t HeardPoses::memory_bytes() const {
  return static_cast<std::int64_t>(positions_.capacity() * sizeof(Position) +
                                   heard_.capacity() * sizeof(Interval));
}

CameraTrack track_through(const std::vector<TimedPose>& known) { return HeardPoses().track(known); }

}  // namespace kintsugi::viewer
