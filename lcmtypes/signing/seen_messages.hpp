#pragma once
// Tells messages that were received before.

#include <cstddef>
#include <cstdint>
#include <list>
#include <unordered_map>

#include "lcmtypes/sequence_set.hpp"

namespace kintsugi {

/// The numbers of the signed messages that one receiver has accepted. Only messages with the right
/// tag may be given to it, so that nobody without the key makes it grow.
///
/// No message is taken twice, whatever is lost, late or out of order. The memory is bounded; at its
/// bounds a message that is very late may be refused:
/// - of a sender with more than `gaps_per_session` gaps in what was received, the lowest gap counts
///   as received;
/// - the sender that was silent for the longest time is forgotten, and from then on no session that
///   is not newer than the forgotten one is begun. MessageSigner begins a new session after a
///   silence, so a sender that is forgotten is heard again.
class SeenMessages {
 public:
  struct Limits {
    std::size_t gaps_per_session = 4096;
    std::size_t gaps = 262'144;  ///< in all sessions, each counted once more; about 25 MB
  };

  explicit SeenMessages(const Limits& limits) : limits_(limits) {}
  SeenMessages() : SeenMessages(Limits()) {}

  /// Returns false when the message was received before, or when that is not known any more.
  bool take(std::uint64_t session, std::int64_t sequence);

  std::size_t num_sessions() const { return senders_.size(); }

 private:
  struct Sender {
    std::uint64_t session = 0;
    SequenceSet numbers;
  };
  using Senders = std::list<Sender>;

  Senders::iterator find_or_begin(std::uint64_t session);
  void forget_longest_silent();

  Limits limits_;
  Senders senders_;  // the one that was silent for the longest time first
  std::unordered_map<std::uint64_t, Senders::iterator> by_session_;
  std::size_t num_ranges_ = 0;     // of all senders
  std::uint32_t forgotten_s_ = 0;  // sessions that began up to then, seconds, may be forgotten
};

}  // namespace kintsugi
