#pragma once
// Puts slices into the order of their ids, on which segment ids and mode `voting` depend.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

/// Missing slices of one session: ids [first, last].
struct SliceGap {
  std::int32_t first = 0;
  std::int32_t last = 0;

  bool operator==(const SliceGap&) const = default;
};

/// Slices for one run of the engine.
struct SliceGroup {
  std::vector<CloudSlice> slices;  ///< one new slice, or corrections by ascending id
  bool is_correction = false;
};

/// What is known about the rest of a stream.
enum class Outlook {
  kLive,    ///< missing slices are being sent again: wait for them
  kSilent,  ///< nobody sends: wait for SliceSequencer::Config::gap_timeout
  kEnded,   ///< no more slices will come
};

/// Memory of a slice.
inline std::size_t bytes_of(const CloudSlice& slice) {
  return sizeof(slice) + slice.points_W.size() * sizeof(CloudPoint);
}

/// Returns the slices of one session in the order of their ids, from 0, in groups for the engine.
///
/// A slice waits while an earlier one is missing. The missing ones are given up when the stream has
/// ended, or when nobody sends them and there was no progress for `gap_timeout`. Then the waiting
/// slices up to the next gap become ready. A slice that comes after it was given up is ready at
/// once.
///
/// A higher revision of a slice that is still waiting replaces it. A higher revision of a slice
/// that was ready before is a correction. Consecutive corrections form one group, so that a moved
/// part of a map is segmented once; for each slice the group has its newest revision. The group is
/// complete when a new slice becomes ready after it, when no correction has come for
/// `correction_quiet`, when it has waited for `gap_timeout`, or when the stream has ended. A
/// revision that is not newer than the known one is a duplicate.
///
/// So the groups and their order depend only on the order of arrival, unless a timeout ends.
class SliceSequencer {
 public:
  using Clock = std::chrono::steady_clock;

  struct Config {
    /// Longer than a restart of the mapper, which takes a few seconds.
    std::chrono::milliseconds gap_timeout{10'000};  ///< > 0
    /// Longer than a rate-limited stream needs for a large slice, 3 MB at 10 MB/s.
    std::chrono::milliseconds correction_quiet{500};  ///< > 0

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };
  enum class Verdict {
    kTaken,
    kReplaced,   ///< a higher revision replaced one that was still waiting
    kCorrected,  ///< a higher revision of a slice that was ready before
    kDuplicate,  ///< already known, in this revision or a higher one
  };
  /// Revisions by slice id.
  using Revisions = std::map<std::int32_t, std::int32_t>;

  /// @param done slices that are in a resumed map; smaller ids that are missing in it count as
  /// given
  ///   up
  /// @throws std::invalid_argument for an invalid config
  explicit SliceSequencer(const Config& config, Revisions done = {});

  Verdict offer(CloudSlice slice, Clock::time_point now);

  /// Removes and returns the first complete group, if there is one.
  std::optional<SliceGroup> pop(Clock::time_point now, Outlook outlook);

  /// The new slice that the next pop() will return; nullptr when there is none, or when corrections
  /// come first.
  [[nodiscard]] const CloudSlice* upcoming() const {
    return ready_.empty() || ready_.front().is_correction ? nullptr
                                                          : &ready_.front().slices.front();
  }

  /// Gives up the first gap, if it is time to, and returns it. Then pop() may return more.
  std::optional<SliceGap> give_up_gap(Clock::time_point now, Outlook outlook);

  /// Slices and corrections that came and were not popped.
  [[nodiscard]] std::int64_t num_waiting() const;

  /// Their memory.
  [[nodiscard]] std::size_t waiting_bytes() const { return waiting_bytes_; }

  /// Slices with an id below the largest seen that have not come.
  [[nodiscard]] std::int64_t num_missing() const;

  /// Those of them that were given up.
  [[nodiscard]] std::int64_t num_given_up() const;

 private:
  void put(CloudSlice& place, CloudSlice slice);
  void make_ready(CloudSlice slice);
  Verdict correct(CloudSlice slice, Clock::time_point now);
  void take_turns();
  [[nodiscard]] bool may_grow(Clock::time_point now) const;

  Config config_;
  std::map<std::int32_t, CloudSlice> waiting_;  // for an earlier slice, by id
  std::deque<SliceGroup> ready_;                // groups, the last one perhaps not complete
  std::int64_t num_ready_ = 0;                  // slices in ready_
  std::size_t waiting_bytes_ = 0;               // of waiting_ and ready_
  Revisions known_;                             // of slices that are ready, or were
  std::int64_t next_id_ = 0;                    // the id to wait for
  std::int64_t end_id_ = 0;                     // one past the largest id seen
  Clock::time_point last_progress_{};           // or when a slice began to wait
  Clock::time_point first_correction_{};        // of the last group in ready_, if it is one
  Clock::time_point last_correction_{};
};

}  // namespace kintsugi::segmenter
