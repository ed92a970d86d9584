#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>

#include "viewer/session/map_session.hpp"

namespace kintsugi::viewer {

/// The newest session of a map and the one before it. The session with the larger number is newer.
class MapSessions {
 public:
  /// `keep_updates`: as in MapSession.
  explicit MapSessions(bool keep_updates) : keep_updates_(keep_updates) {}

  /// The session with this number, created if necessary; nullptr when it is older than the sessions
  /// that are kept. Check has_too_many() afterwards.
  MapSession* find_or_create(std::int64_t session, double now_s);

  MapSession* find(std::int64_t session);

  /// Gives the pose to its session. A pose does not name its map, so it does not create a session,
  /// but waits until there is one.
  void use(const CameraPose& pose);

  /// The newest session with slices, otherwise the newest session; nullptr when there is none.
  const MapSession* current() const;
  MapSession* current();

  bool has_too_many() const { return sessions_.size() > kMaxSessions; }
  /// The oldest session, if it is older than the current one; otherwise nullptr.
  MapSession* replaced();
  /// Removes the oldest session. Sessions with its number or a smaller one are ignored from now on.
  void forget_oldest();

  std::map<std::int64_t, MapSession>& all() { return sessions_; }  ///< oldest first
  const std::map<std::int64_t, MapSession>& all() const { return sessions_; }

 private:
  static constexpr std::size_t kMaxSessions = 2;
  static constexpr std::size_t kMaxWaitingPoses = 10'000;  ///< 5 minutes at 30 Hz

  bool is_too_old(std::int64_t session) const;

  bool keep_updates_;
  std::map<std::int64_t, MapSession> sessions_;  // by number
  std::int64_t forgotten_until_ = 0;
  std::deque<CameraPose> waiting_poses_;
};

}  // namespace kintsugi::viewer
