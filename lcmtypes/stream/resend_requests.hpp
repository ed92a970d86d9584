#pragma once
// Decides when a receiver requests missing chunks of a stream, and when it gives up.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "lcmtypes/sequence_set.hpp"

namespace kintsugi {

/// The schedule of requests for the missing chunks in a range of sequence numbers of one session.
/// It has no thread and no clock: times are seconds that never decrease, from a PatientClock, so
/// that a process that was stopped does not give up chunks that it could not receive.
class ResendRequests {
 public:
  struct Config {
    double first_wait_s = 0.05;  ///< a chunk that is missing longer is lost, not out of order
    double min_wait_s = 0.1;     ///< between two requests; doubles while nothing is received
    double max_wait_s = 1.0;
    double give_up_after_s = 5.0;  ///< of requests without any requested chunk received
    double retry_period_s = 10.0;  ///< between requests after that, while the sender is alive
    double silence_s = 1.0;        ///< a sender that is heard again after so long is asked at once
  };
  struct Limits {
    std::size_t max_ranges = 0;
    std::int64_t max_numbers = 0;
    std::int64_t end = 0;  ///< nothing from here on is requested
  };

  explicit ResendRequests(const Config& config) : config_(config) {}

  /// To be called when chunks are received for the first time, or need not be received any more.
  void arrived(const SequenceRange& chunks);

  /// The numbers to request now, lowest first: some of those in [begin, end) that are not in
  /// `seen`.
  /// @param heard a message of the sender was received since the last call
  std::vector<SequenceRange> poll(const SequenceSet& seen, std::int64_t begin, std::int64_t end,
                                  const Limits& limits, bool heard, double now_s);

  /// To be called instead of poll() while there is no memory for more chunks: this time does not
  /// count towards give_up_after_s.
  void pause(double now_s);

  /// The sender does not answer: the missing chunks are given up until it is heard again.
  bool has_given_up() const { return has_given_up_; }

 private:
  struct Mark {
    double time_s = 0.0;
    std::int64_t end = 0;
  };

  void start_afresh(double now_s);
  void note_hearing(bool heard, double now_s);
  std::int64_t overdue_end(std::int64_t end, double now_s);

  Config config_;
  std::deque<Mark> marks_;              // the end of the known numbers over time
  std::optional<SequenceRange> asked_;  // from the lowest to the highest number of the last request
  bool has_progress_ = false;           // a requested chunk was received
  bool has_given_up_ = false;
  bool was_heard_ = false;  // since the last request
  double wait_s_ = 0.0;
  double next_ask_s_ = 0.0;
  double in_vain_since_s_ = 0.0;
  double last_heard_s_ = 0.0;
};

}  // namespace kintsugi
