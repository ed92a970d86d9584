#include "viewer/process/map_sessions.hpp"

#include <spdlog/spdlog.h>

namespace kintsugi::viewer {

SessionScene* MapSessions::enter(std::int64_t session, double now_s) {
  if (SessionScene* const scene = find(session)) return scene;
  if (is_too_old(session)) return nullptr;
  if (!scenes_.empty() && session > scenes_.rbegin()->first) {
    spdlog::info("map session {} follows {}", session, scenes_.rbegin()->first);
  }
  SessionScene& scene = scenes_.try_emplace(session, session, now_s, keep_updates_).first->second;
  for (const CameraPose& pose : waiting_poses_) {
    if (pose.session == session) scene.use(pose);
  }
  std::erase_if(waiting_poses_, [&](const CameraPose& pose) { return pose.session == session; });
  return &scene;
}

bool MapSessions::is_too_old(std::int64_t session) const {
  const bool is_before_all = !scenes_.empty() && session < scenes_.begin()->first;
  return session <= forgotten_until_ || (scenes_.size() >= kMaxScenes && is_before_all);
}

SessionScene* MapSessions::find(std::int64_t session) {
  const auto found = scenes_.find(session);
  return found == scenes_.end() ? nullptr : &found->second;
}

void MapSessions::use(const CameraPose& pose) {
  if (SessionScene* const scene = find(pose.session)) {
    scene->use(pose);
    return;
  }
  waiting_poses_.push_back(pose);
  if (waiting_poses_.size() > kMaxWaitingPoses) waiting_poses_.pop_front();
}

std::optional<std::int64_t> MapSessions::current() const {
  for (auto it = scenes_.rbegin(); it != scenes_.rend(); ++it) {
    if (!it->second.is_empty()) return it->first;
  }
  return scenes_.empty() ? std::nullopt : std::optional(scenes_.rbegin()->first);
}

const SessionScene* MapSessions::current_scene() const {
  const auto session = current();
  return session ? &scenes_.at(*session) : nullptr;
}

SessionScene* MapSessions::current_scene() {
  const auto session = current();
  return session ? &scenes_.at(*session) : nullptr;
}

SessionScene* MapSessions::replaced() {
  const bool is_replaced = !scenes_.empty() && scenes_.begin()->first < *current();
  return is_replaced ? &scenes_.begin()->second : nullptr;
}

void MapSessions::forget_oldest() {
  forgotten_until_ = scenes_.begin()->first;
  scenes_.erase(scenes_.begin());
}

}  // namespace kintsugi::viewer
