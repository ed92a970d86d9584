#include "viewer/session/map_session.hpp"

#include <utility>

namespace kintsugi::viewer {

void MapSession::note_change(double now_s) {
  last_change_s_ = now_s;
  final_suffix_.reset();
}

void MapSession::use(CloudSlice slice, double now_s) {
  CameraPose pose;  // replaces one that was not received
  pose.utime = slice.utime;
  pose.state = TrackingState::kTracking;
  pose.X_WC = slice.X_WC;
  if (!map_.add_slice(std::move(slice))) return;
  depth_camera_.update(pose, map_.up().up_W());
  note_change(now_s);
}

void MapSession::use(const SegmentUpdate& update, double now_s) {
  if (keep_updates_) updates_.add(update);
  if (!map_.apply_update(update)) return;
  history_.add_lag(map_);
  note_change(now_s);
}

void MapSession::use(const CameraPose& pose) {
  if (map_.add_pose(pose)) depth_camera_.update(pose, map_.up().up_W());
}

void MapSession::use(const SegmentAnswer& answer) {
  if (answer.utime < answer_utime_ || !answer.problem.empty()) return;
  answer_utime_ = answer.utime;
  answered_.clear();
  for (const DescribedSegment& segment : answer.segments) {
    answered_.insert(segment.statistics.segment_id);
  }
  is_answer_new_ = true;
}

bool MapSession::snapshot_is_due(int every_slices) const {
  const MapCounts& now = map_.counts();
  const std::int64_t more = now.updates > 0 ? now.labellings - counts_at_snapshot_.labellings
                                            : now.slices - counts_at_snapshot_.slices;
  return more >= every_slices && map_.newest_slice() != nullptr;
}

bool MapSession::frame_is_due(double period_s) const {
  if (is_empty()) return false;
  const double elapsed_s = 1e-6 * static_cast<double>(map_.utime() - last_frame_utime_.value_or(0));
  return !last_frame_utime_ || elapsed_s >= period_s;
}

}  // namespace kintsugi::viewer
