#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>

#include "viewer/process/session_scene.hpp"

namespace kintsugi::viewer {

/// The scenes of the newest session of a map and of the one before; a larger number is newer.
class MapSessions {
 public:
  /// `keep_updates`: as in SessionScene.
  explicit MapSessions(bool keep_updates) : keep_updates_(keep_updates) {}

  /// The scene of a session, begun if need be. nullptr: it is earlier than those that are wanted.
  /// When has_too_many() after it, the oldest is to be forgotten.
  SessionScene* enter(std::int64_t session, double now_s);

  SessionScene* find(std::int64_t session);

  /// Poses begin no scene, because they do not say of which map they are; they wait for it.
  void use(const CameraPose& pose);

  /// The newest session that has something to show; nothing when there is no session at all.
  std::optional<std::int64_t> current() const;
  const SessionScene* current_scene() const;
  SessionScene* current_scene();

  bool has_too_many() const { return scenes_.size() > kMaxScenes; }
  /// The oldest, when there is a newer one to show; nullptr otherwise.
  SessionScene* replaced();
  /// Nothing more is wanted of the oldest session and those before it.
  void forget_oldest();

  std::map<std::int64_t, SessionScene>& scenes() { return scenes_; }
  const std::map<std::int64_t, SessionScene>& scenes() const { return scenes_; }

 private:
  static constexpr std::size_t kMaxScenes = 2;
  static constexpr std::size_t kMaxWaitingPoses = 10'000;  ///< 5 minutes at 30 Hz

  bool is_too_old(std::int64_t session) const;

  bool keep_updates_;
  std::map<std::int64_t, SessionScene> scenes_;  // by session
  std::int64_t forgotten_until_ = 0;
  std::deque<CameraPose> waiting_poses_;
};

}  // namespace kintsugi::viewer
