#pragma once
// The sequence numbers of one session of a stream at a receiver: which chunks exist, were received,
// and are missing.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "lcmtypes/sequence_set.hpp"
#include "lcmtypes/stream/resend_requests.hpp"

namespace kintsugi {

/// How much memory a receiver has for further chunks.
enum class StreamRoom {
  kPlenty,
  kOnlyNext,  ///< only for the missing chunks with the lowest numbers
  kNone,
};

/// The numbers of one session. It has no messages, no thread and no clock.
class StreamSession {
 public:
  explicit StreamSession(const ResendRequests::Config& config)
      : lost_requests_(config), requests_(config) {}

  /// Takes over what the sender announces. A heartbeat with a lower number than the one before
  /// counts only if the next one confirms it: it may be late, or false.
  void hear(const Heartbeat& heartbeat);
  /// To be called when a chunk is received, whether it is kept or not.
  void note(std::int64_t sequence);

  /// The chunk was kept, or a full state replaces it.
  bool has(std::int64_t sequence) const;
  /// The chunk may be kept. The missing chunk with the lowest number always may, unless `room` is
  /// kNone.
  bool takes(std::int64_t sequence, StreamRoom room, std::size_t max_gaps) const;
  void keep(std::int64_t sequence, std::size_t bytes);
  /// Adds chunks that an earlier run of this receiver has kept.
  void restore(const std::vector<SequenceRange>& ranges);
  void drop(std::int64_t sequence) { seen_.erase(sequence); }
  /// Newer chunks have replaced these: they are not waited for. Does nothing, and returns false, if
  /// there would be more than `max_gaps` gaps.
  bool replace(const std::vector<SequenceRange>& ranges, std::size_t max_gaps);

  /// The chunks to request now, of about `max_bytes` in total.
  std::vector<SequenceRange> poll(StreamRoom room, std::int64_t max_bytes, std::size_t max_ranges,
                                  double now_s);

  std::vector<SequenceRange> missing(std::size_t max_ranges) const;
  std::int64_t count_missing() const;
  std::int64_t count_given_up() const;
  bool is_complete() const { return missing(1).empty(); }
  /// Chunks are missing, and all of them have been given up.
  bool has_given_up() const { return !is_complete() && count_given_up() == count_missing(); }

  std::int64_t state_sequence() const { return state_; }
  std::int64_t first_sequence() const { return first_; }
  std::int64_t next_sequence() const { return next_; }
  std::int64_t chunks_kept() const { return chunks_came_ + chunks_restored_; }

 private:
  std::int64_t resendable() const;

  SequenceSet seen_;
  std::int64_t state_ = 0;  // start of the newest full state
  std::int64_t first_ = 0;  // the lowest that the sender can resend
  std::int64_t next_ = 0;   // one past the highest that exists
  bool doubts_ = false;     // the last heartbeat had a lower number than the one before
  bool heard_ = false;      // since the last poll()
  std::int64_t chunks_came_ = 0;
  std::int64_t bytes_came_ = 0;
  std::int64_t chunks_restored_ = 0;
  ResendRequests lost_requests_;  // for [state_, first_), which the sender no longer has: it sends
                                  // a full state
  ResendRequests requests_;       // for [first_, next_)
};

}  // namespace kintsugi
