#pragma once
// The sessions of a stream at a receiver.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <tuple>

#include "lcmtypes/stream/message_assembler.hpp"
#include "lcmtypes/stream/stream_session.hpp"

namespace kintsugi {

/// A bounded number of sessions, and the ids of the sessions that have ended.
template <BulkMessage Message>
class StreamSessions {
 public:
  struct Session {
    explicit Session(const ResendRequests::Config& config) : numbers(config) {}

    StreamSession numbers;
    MessageAssembler<Message> messages;
    std::int64_t last_heard = 0;
  };

  StreamSessions(const ResendRequests::Config& requests, std::size_t max_sessions)
      : requests_(requests), max_sessions_(max_sessions) {}

  /// The session of a message that was received; created if it is new, null if it has ended. If
  /// there are too many sessions, the one with the fewest chunks is dropped, of equal ones the one
  /// that was silent longest: so invented sessions do not displace real ones.
  Session* heard_of(std::int64_t id) {
    if (over_.contains(id)) return nullptr;
    if (!all_.contains(id) && all_.size() >= max_sessions_) all_.erase(least());
    Session& session = all_.try_emplace(id, requests_).first->second;
    session.last_heard = ++clock_;
    return &session;
  }

  /// The session; null if it is unknown.
  const Session* find(std::int64_t id) const {
    const auto session = all_.find(id);
    return session != all_.end() ? &session->second : nullptr;
  }

  /// Frees the session's memory; later messages of it are ignored.
  void end(std::int64_t id) {
    all_.erase(id);
    over_.insert(id);
    if (over_.size() > kMaxOver) over_.erase(over_.begin());  // the oldest session
  }

  std::size_t pending_bytes() const {
    std::size_t bytes = 0;
    for (const auto& [id, session] : all_) bytes += session.messages.bytes();
    return bytes;
  }

  std::map<std::int64_t, Session>& all() { return all_; }
  const std::map<std::int64_t, Session>& all() const { return all_; }

 private:
  static constexpr std::size_t kMaxOver = 4'096;

  typename std::map<std::int64_t, Session>::iterator least() {
    const auto worth = [](const Session& session) {
      return std::tuple(session.numbers.chunks_kept(), session.last_heard);
    };
    return std::min_element(all_.begin(), all_.end(), [&](const auto& a, const auto& b) {
      return worth(a.second) < worth(b.second);
    });
  }

  const ResendRequests::Config requests_;
  const std::size_t max_sessions_;
  std::map<std::int64_t, Session> all_;
  std::set<std::int64_t> over_;
  std::int64_t clock_ = 0;  // counts received messages
};

}  // namespace kintsugi
