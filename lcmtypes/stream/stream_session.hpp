#pragma once
// What a receiver knows of one session of a stream: which chunks exist, came, and are missing.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "lcmtypes/stream/resend_requests.hpp"
#include "lcmtypes/stream/sequence_set.hpp"

namespace kintsugi {

/// How much a receiver can take.
enum class StreamRoom {
  kPlenty,
  kOnlyNext,  ///< only the chunks that are missing lowest
  kNone,
};

/// The numbers of one session; no messages, thread or clock.
class StreamSession {
 public:
  explicit StreamSession(const ResendRequests::Config& config)
      : lost_requests_(config), requests_(config) {}

  /// The sender says what exists. A heartbeat that takes something back is believed when the next
  /// one says so too: it may be late, or false.
  void hear(const Heartbeat& heartbeat);
  /// A chunk with this number came, whether it is kept or not.
  void note(std::int64_t sequence);

  /// The chunk is there, or superseded by a full state.
  bool has(std::int64_t sequence) const;
  /// There is room for the chunk: for what is missing lowest always, unless there is none at all.
  bool takes(std::int64_t sequence, StreamRoom room, std::size_t max_gaps) const;
  void keep(std::int64_t sequence, std::size_t bytes);
  /// Chunks that an earlier run of this receiver has kept.
  void restore(const std::vector<SequenceRange>& ranges);
  void drop(std::int64_t sequence) { seen_.erase(sequence); }

  /// What to ask for now; `max_bytes` is an estimate of what comes of it.
  std::vector<SequenceRange> poll(StreamRoom room, std::int64_t max_bytes, std::size_t max_ranges,
                                  double now_s);

  std::vector<SequenceRange> missing(std::size_t max_ranges) const;
  std::int64_t count_missing() const;
  std::int64_t count_given_up() const;
  bool is_complete() const { return missing(1).empty(); }
  /// Something is missing, and all of it has been given up.
  bool has_given_up() const { return !is_complete() && count_given_up() == count_missing(); }

  std::int64_t state_sequence() const { return state_; }
  std::int64_t first_sequence() const { return first_; }
  std::int64_t next_sequence() const { return next_; }
  std::int64_t chunks_kept() const { return chunks_came_ + chunks_restored_; }

 private:
  std::int64_t resendable() const;

  SequenceSet seen_;
  std::int64_t state_ = 0;  // what is below is superseded
  std::int64_t first_ = 0;  // the oldest that the sender can resend
  std::int64_t next_ = 0;   // one past the newest that exists
  bool doubts_ = false;     // the last heartbeat took something back
  bool heard_ = false;      // since the last poll
  std::int64_t chunks_came_ = 0;
  std::int64_t bytes_came_ = 0;
  std::int64_t chunks_restored_ = 0;
  ResendRequests lost_requests_;  // for [state_, first_), which only a new full state can replace
  ResendRequests requests_;       // for [first_, next_)
};

}  // namespace kintsugi
