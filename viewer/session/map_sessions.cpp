#include "viewer/session/map_sessions.hpp"

#include "lcmtypes/base/logger.hpp"

namespace kintsugi::viewer {
namespace {

template <class Sessions>
auto* current_of(Sessions& sessions) {
  for (auto it = sessions.rbegin(); it != sessions.rend(); ++it) {
    if (!it->second.is_empty()) return &it->second;
  }
  return sessions.empty() ? nullptr : &sessions.rbegin()->second;
}

}  // namespace

MapSession* MapSessions::find_or_create(std::int64_t session, double now_s) {
  if (MapSession* const found = find(session)) return found;
  if (is_too_old(session)) return nullptr;
  if (!sessions_.empty() && session > sessions_.rbegin()->first) {
    spdlog::info("map session {} follows {}", session, sessions_.rbegin()->first);
  }
  MapSession& created = sessions_.try_emplace(session, session, now_s, keep_updates_).first->second;
  for (const CameraPose& pose : waiting_poses_) {
    if (pose.session == session) created.use(pose);
  }
  std::erase_if(waiting_poses_, [&](const CameraPose& pose) { return pose.session == session; });
  return &created;
}

bool MapSessions::is_too_old(std::int64_t session) const {
  const bool is_before_all = !sessions_.empty() && session < sessions_.begin()->first;
  return session <= forgotten_until_ || (sessions_.size() >= kMaxSessions && is_before_all);
}

MapSession* MapSessions::find(std::int64_t session) {
  const auto found = sessions_.find(session);
  return found == sessions_.end() ? nullptr : &found->second;
}

void MapSessions::use(const CameraPose& pose) {
  if (MapSession* const session = find(pose.session)) {
    session->use(pose);
    return;
  }
  waiting_poses_.push_back(pose);
  if (waiting_poses_.size() > kMaxWaitingPoses) waiting_poses_.pop_front();
}

const MapSession* MapSessions::current() const { return current_of(sessions_); }

MapSession* MapSessions::current() { return current_of(sessions_); }

MapSession* MapSessions::replaced() {
  if (sessions_.empty() || &sessions_.begin()->second == current()) return nullptr;
  return &sessions_.begin()->second;
}

void MapSessions::forget_oldest() {
  forgotten_until_ = sessions_.begin()->first;
  sessions_.erase(sessions_.begin());
}

}  // namespace kintsugi::viewer
