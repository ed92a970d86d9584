#pragma once
// When to ask for what is missing of a stream, and when to stop.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "lcmtypes/stream/sequence_set.hpp"

namespace kintsugi {

/// The schedule of asking for what is missing between two numbers of one session. No thread, no
/// clock: times are seconds that never decrease; PatientClock's, so that a process that was stopped
/// does not give up what it could not receive.
class ResendRequests {
 public:
  struct Config {
    double first_wait_s = 0.05;  ///< a number that is missing longer is lost, not out of order
    double min_wait_s = 0.1;     ///< before asking again; doubles while nothing comes of it
    double max_wait_s = 1.0;
    double give_up_after_s = 5.0;  ///< of asking in vain
    double retry_period_s = 10.0;  ///< after that, while the sender is heard
    double silence_s = 1.0;        ///< a sender heard again after it has come back: asked at once
  };
  struct Limits {
    std::size_t max_ranges = 0;
    std::int64_t max_numbers = 0;
    std::int64_t end = 0;  ///< nothing from here on is asked for
  };

  explicit ResendRequests(const Config& config) : config_(config) {}

  /// A number came that was not there before.
  void arrived(std::int64_t sequence);

  /// What to ask for now, lowest first: some of the numbers in [begin, end) that are not in `seen`.
  /// `heard`: the sender has said something since the last call.
  std::vector<SequenceRange> poll(const SequenceSet& seen, std::int64_t begin, std::int64_t end,
                                  const Limits& limits, bool heard, double now_s);

  /// There is no room for what would come: time spent so is not time spent in vain.
  void pause(double now_s);

  /// Nobody answers: what is missing is given up, until the sender is heard again.
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
  std::deque<Mark> marks_;              // up to where numbers were known to exist, and when
  std::optional<SequenceRange> asked_;  // from the lowest to the highest number last asked for
  bool has_progress_ = false;           // something asked for has come
  bool has_given_up_ = false;
  bool was_heard_ = false;  // since last asked
  double wait_s_ = 0.0;
  double next_ask_s_ = 0.0;
  double in_vain_since_s_ = 0.0;
  double last_heard_s_ = 0.0;
};

}  // namespace kintsugi
