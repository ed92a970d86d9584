#include "viewer/process/session_scene.hpp"

#include <utility>

namespace kintsugi::viewer {

void SessionScene::note_news(double now_s) {
  last_news_s_ = now_s;
  final_suffix_.reset();
}

void SessionScene::use(CloudSlice slice, double now_s) {
  CameraPose pose;  // stands in for one that was not heard
  pose.utime = slice.utime;
  pose.state = TrackingState::kTracking;
  pose.X_WC = slice.X_WC;
  if (!scene_.add_slice(std::move(slice))) return;
  followed_.update(pose, scene_.up().up_W());
  note_news(now_s);
}

void SessionScene::use(const SegmentUpdate& update, double now_s) {
  if (keeps_updates_) updates_.add(update);
  if (!scene_.apply_update(update)) return;
  history_.add_lag(scene_);
  note_news(now_s);
}

void SessionScene::use(const CameraPose& pose) {
  if (scene_.add_pose(pose)) followed_.update(pose, scene_.up().up_W());
}

void SessionScene::use(const SegmentAnswer& answer) {
  if (answer.utime < answer_utime_ || !answer.problem.empty()) return;
  answer_utime_ = answer.utime;
  answered_.clear();
  for (const DescribedSegment& segment : answer.segments) {
    answered_.insert(segment.statistics.segment_id);
  }
  is_answer_new_ = true;
}

bool SessionScene::snapshot_is_due(int every_slices) const {
  const SceneCounts& now = scene_.counts();
  const std::int64_t more =
      now.updates > 0 ? now.labellings - in_snapshot_.labellings : now.slices - in_snapshot_.slices;
  return more >= every_slices && scene_.newest_slice() != nullptr;
}

bool SessionScene::frame_is_due(double period_s) const {
  if (is_empty()) return false;
  const double elapsed_s =
      1e-6 * static_cast<double>(scene_.utime() - last_frame_utime_.value_or(0));
  return !last_frame_utime_ || elapsed_s >= period_s;
}

}  // namespace kintsugi::viewer
