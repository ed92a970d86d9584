#include "viewer/core/map/camera_track.hpp"

#include <algorithm>

namespace kintsugi::viewer {

bool ReceivedPoses::add(const CameraPose& pose) {
  if (!is_located(pose.state)) return false;
  if (newest_ && pose.utime <= newest_->utime) return false;
  if (intervals_.empty() || pose.utime - intervals_.back().last_utime > kMaxInterval_us) {
    intervals_.push_back({pose.utime, pose.utime});
  }
  intervals_.back().last_utime = pose.utime;
  newest_ = TimedPose{pose.utime, pose.X_WC};
  const Eigen::Vector3f position_W = pose.X_WC.translation().cast<float>();
  if (positions_.empty() || (position_W - positions_.back().position_W).norm() >= kStep_m) {
    positions_.push_back({pose.utime, position_W});
  }
  return true;
}

bool ReceivedPoses::covers(std::int64_t utime) const {
  const auto after = std::ranges::upper_bound(intervals_, utime, {}, &Interval::first_utime);
  return after != intervals_.begin() && utime <= std::prev(after)->last_utime;
}

CameraTrack ReceivedPoses::track(const std::vector<TimedPose>& known) const {
  CameraTrack track;
  track.path_W.reserve(positions_.size() + known.size());
  auto received = positions_.begin();
  for (const TimedPose& pose : known) {
    if (covers(pose.utime)) continue;
    for (; received != positions_.end() && received->utime < pose.utime; ++received) {
      track.path_W.push_back(received->position_W);
    }
    track.path_W.emplace_back(pose.X_WC.translation().cast<float>());
  }
  for (; received != positions_.end(); ++received) track.path_W.push_back(received->position_W);

  const bool is_known_later = !known.empty() && (!newest_ || known.back().utime > newest_->utime);
  if (is_known_later) {
    track.X_WC = known.back().X_WC;
  } else if (newest_) {
    track.X_WC = newest_->X_WC;
  }
  return track;
}

CameraTrack track_through(const std::vector<TimedPose>& known) {
  return ReceivedPoses().track(known);
}

}  // namespace kintsugi::viewer
