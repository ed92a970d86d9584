#pragma once
// The canonical order of slices: persistent ids, and the mode `voting`, depend on it.

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>

#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

/// Slices of one session that are missing: ids [first, last].
struct SliceGap {
  std::int32_t first = 0;
  std::int32_t last = 0;

  bool operator==(const SliceGap&) const = default;
};

/// Hands on the slices of one session in the order of their ids, from 0.
///
/// A slice waits while an earlier one is missing. When nothing has come forward for
/// `gap_timeout`, or the stream has ended, the missing ones are given up: what waits is handed on
/// up to the next gap. A slice given up that comes after all is handed on at once.
class SliceSequencer {
 public:
  using Clock = std::chrono::steady_clock;

  struct Config {
    /// Resends of a live stream take well under a second each; a restart of the mapper more.
    std::chrono::milliseconds gap_timeout{10'000};  ///< > 0

    void validate() const;
  };
  enum class Verdict {
    kTaken,
    kReplaced,   ///< a correction of a slice that was still waiting took its place
    kDuplicate,  ///< had it, in this revision or a later one
    kRevision,   ///< a correction of a slice that has been handed on: not supported yet, dropped
  };

  explicit SliceSequencer(const Config& config);

  /// A higher revision of a slice that still waits replaces it.
  Verdict offer(CloudSlice slice, Clock::time_point now);

  /// The next slice in order, when it is there.
  std::optional<CloudSlice> pop(Clock::time_point now);

  /// Gives up the first gap when it is time to; returns it. Then pop() again.
  std::optional<SliceGap> give_up_gap(Clock::time_point now, bool stream_has_ended);

  [[nodiscard]] std::int64_t num_waiting() const {
    return static_cast<std::int64_t>(waiting_.size());
  }
  /// Ids below the largest seen that were neither handed on nor are waiting.
  [[nodiscard]] std::int64_t num_missing() const;

  /// Of those, the ones nobody waits for any more.
  [[nodiscard]] std::int64_t num_given_up() const;

 private:
  Config config_;
  std::map<std::int32_t, CloudSlice> waiting_;      // by id
  std::map<std::int32_t, std::int32_t> handed_on_;  // revision by id
  std::int64_t next_id_ = 0;                        // the one to wait for
  std::int64_t end_id_ = 0;                         // one past the largest seen
  Clock::time_point last_progress_{};               // or since when something waits
};

}  // namespace kintsugi::segmenter
