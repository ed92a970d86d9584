#pragma once
// The sessions of a stream that a receiver keeps.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <tuple>

#include "lcmtypes/stream/message_assembler.hpp"
#include "lcmtypes/stream/stream_session.hpp"

namespace kintsugi {

/// A bounded number of sessions, and the numbers of those that are over.
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

  /// The session of which something was heard, a new one if need be; null: it is over. When there
  /// are too many the one with the fewest chunks goes, of several the one longest silent: so made
  /// up sessions do not drive out a true one.
  Session* heard_of(std::int64_t id) {
    if (over_.contains(id)) return nullptr;
    if (!all_.contains(id) && all_.size() >= max_sessions_) all_.erase(least());
    Session& session = all_.try_emplace(id, requests_).first->second;
    session.last_heard = ++clock_;
    return &session;
  }

  /// The session; null: nothing is known of it.
  const Session* find(std::int64_t id) const {
    const auto session = all_.find(id);
    return session != all_.end() ? &session->second : nullptr;
  }

  /// Frees the session's memory, and remembers that it is over.
  void end(std::int64_t id) {
    all_.erase(id);
    over_.insert(id);
    if (over_.size() > kMaxOver) over_.erase(over_.begin());  // the oldest
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
  std::int64_t clock_ = 0;  // counts what was heard
};

}  // namespace kintsugi
