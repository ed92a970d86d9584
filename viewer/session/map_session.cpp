#include "viewer/session/map_session.hpp"

#include <algorithm>
#include <utility>

namespace kintsugi::viewer {

void MapSession::note_change(double now_s) {
  last_change_s_ = now_s;
  final_suffix_.reset();
}

void MapSession::use(CloudSlice slice, double now_s) {
  const bool is_newest = slice.utime > map_.utime();
  CameraPose pose;  // replaces one that was not received
  pose.utime = slice.utime;
  pose.state = TrackingState::kTracking;
  pose.X_WC = slice.X_WC;
  pose.part = slice.part;
  const std::int32_t id = slice.id;
  if (!map_.add_slice(std::move(slice))) return;
  slice_utime_ = std::max(slice_utime_, pose.utime);
  note_labelled(id);
  if (is_newest) follow(pose);
  note_change(now_s);
}

void MapSession::use(const SegmentUpdate& update, double now_s) {
  if (keep_updates_) updates_.add(update);
  if (!map_.apply_update(update)) return;
  note_labelled(update.slice_id);
  history_.add_lag(map_);
  note_change(now_s);
}

void MapSession::note_labelled(std::int32_t slice_id) {
  const MapSlice* const slice = map_.slice(slice_id);
  if (slice == nullptr || !slice->was_labelled()) return;
  labelled_utime_ = std::max(labelled_utime_, slice->utime());
}

void MapSession::use(const CameraPose& pose) {
  if (map_.add_pose(pose)) follow(pose);
}

void MapSession::follow(const CameraPose& pose) {
  if (pose.utime > camera_utime_) {
    camera_utime_ = pose.utime;
    camera_part_ = pose.part;
  }
  depth_cameras_[pose.part].update(pose, map_.up(pose.part).up_W());
}

const SmoothedCamera& MapSession::depth_camera(std::int32_t part) const {
  static const SmoothedCamera kWithoutPose;
  const auto found = depth_cameras_.find(part);
  return found == depth_cameras_.end() ? kWithoutPose : found->second;
}

void MapSession::use(const SegmentAnswer& answer) {
  if (answer.utime < answer_utime_ || !answer.problem.empty()) return;
  if (!answer.views.empty()) return;  // nobody has asked for segments
  answer_utime_ = answer.utime;
  answered_.clear();
  for (const DescribedSegment& segment : answer.segments) {
    answered_.insert(segment.statistics.segment_id);
  }
  is_answer_new_ = true;
}

void MapSession::use(const ObjectDetection& detection, double now_s) {
  if (objects_.apply(detection, now_s)) final_suffix_.reset();
}

void MapSession::use(const DetectorStatus& status, double now_s) {
  objects_.hear_sender(status.map_session, status.session, now_s);
  if (status.session != objects_.session()) return;  // of one before
  searched_s_.reset();
  if (!status.finished) searched_s_ = now_s;
}

std::vector<DrawnObject> MapSession::objects() const {
  std::vector<DrawnObject> drawn;
  for (const ObjectDetection& detection : objects_.present()) {
    drawn.push_back({.name = detection.name,
                     .X_WO = detection.X_WO,
                     .box_min_O = Eigen::Map<const Eigen::Vector3f>(detection.box_min_O),
                     .box_max_O = Eigen::Map<const Eigen::Vector3f>(detection.box_max_O),
                     .is_confirmed = detection.event != DetectionEvent::kFound});
  }
  return drawn;
}

void MapSession::use(CameraView view) {
  if (view_ && view.utime <= view_->utime) return;
  CameraPose pose;  // replaces one that was not received
  pose.utime = view.utime;
  pose.state = view.state;
  pose.X_WC = view.X_WC;
  pose.part = view.part;
  if (view.utime > camera_utime_) use(pose);
  map_.note_time(view.utime);
  view_ = std::move(view);
}

std::int64_t MapSession::utime_of_snapshot() const {
  const std::int64_t of_map = map_.counts().updates > 0 ? labelled_utime_ : slice_utime_;
  return std::max(of_map, view_ ? view_->utime : 0);
}

bool MapSession::snapshot_is_due(double every_s) const {
  if (is_empty()) return false;
  const bool has_segments = map_.counts().labelled_slices > 0;
  if (snapshot_ && has_segments && !snapshot_->has_segments) return true;
  const std::int64_t last_utime = snapshot_ ? snapshot_->utime : map_.first_utime();
  return 1e-6 * static_cast<double>(utime_of_snapshot() - last_utime) >= every_s;
}

void MapSession::note_snapshot() {
  snapshot_ = Snapshot{utime_of_snapshot(), map_.counts().labelled_slices > 0};
}

}  // namespace kintsugi::viewer
