#pragma once
// The canonical order of slices: persistent ids, and the mode `voting`, depend on it.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

/// Slices of one session that are missing: ids [first, last].
struct SliceGap {
  std::int32_t first = 0;
  std::int32_t last = 0;

  bool operator==(const SliceGap&) const = default;
};

/// Slices that belong into one run of the engine.
struct SliceGroup {
  std::vector<CloudSlice> slices;  ///< one new slice, or corrections by ascending id
  bool is_correction = false;
};

/// What may still come of a stream.
enum class Outlook {
  kLive,    ///< what is missing is being sent again: wait for it
  kSilent,  ///< nobody sends it: wait for SliceSequencer::Config::gap_timeout
  kEnded,   ///< nothing comes any more
};

/// Memory of a slice.
inline std::size_t bytes_of(const CloudSlice& slice) {
  return sizeof(slice) + slice.points_W.size() * sizeof(CloudPoint);
}

/// Hands on the slices of one session in the order of their ids, from 0.
///
/// A slice waits while an earlier one is missing. When nothing has come forward for `gap_timeout`
/// and nobody sends what is missing, or the stream has ended, the missing ones are given up: what
/// waits is handed on up to the next gap. A slice given up that comes after all is handed on at
/// once.
///
/// A higher revision of a slice that still waits for an earlier one takes its place. Of a slice
/// whose turn has come it is a correction: it goes behind what is ready, and all corrections that
/// come one after the other are one run, so that a moved part of a map is segmented once. The run
/// is complete when a new slice gets its turn, when no correction has come for
/// `correction_quiet`, when it has waited for `gap_timeout`, or when the stream has ended. In a run
/// the newest revision of a slice stands for it; a revision that is no newer than what is known is
/// a duplicate.
///
/// What is run, and in which order, therefore follows from the order of arrival alone, however
/// fast it is fetched, except where a time runs out.
class SliceSequencer {
 public:
  using Clock = std::chrono::steady_clock;

  struct Config {
    /// Resends of a live stream are waited for; a restart of the mapper takes a few seconds.
    std::chrono::milliseconds gap_timeout{10'000};  ///< > 0
    /// Longer than a paced stream needs for a large slice, 3 MB at 10 MB/s.
    std::chrono::milliseconds correction_quiet{500};  ///< > 0

    /// Throws std::invalid_argument naming field, value and bound.
    void validate() const;
  };
  enum class Verdict {
    kTaken,
    kReplaced,   ///< a higher revision took the place of one that was still waiting
    kCorrected,  ///< a higher revision of a slice whose turn had come
    kDuplicate,  ///< had it, in this revision or a later one
  };
  /// Revisions by slice id.
  using Revisions = std::map<std::int32_t, std::int32_t>;

  /// @param done slices that have been handed on before, by a segmenter that is resumed; ids below
  ///   the largest that are not among them count as given up
  /// @throws std::invalid_argument for an invalid config
  explicit SliceSequencer(const Config& config, Revisions done = {});

  Verdict offer(CloudSlice slice, Clock::time_point now);

  /// The next run that is complete, when there is one.
  std::optional<SliceGroup> pop(Clock::time_point now, Outlook outlook);

  /// The slice that pop() will give next if nothing else comes; nullptr when there is none, or when
  /// corrections come first.
  [[nodiscard]] const CloudSlice* upcoming() const {
    return ready_.empty() || ready_.front().is_correction ? nullptr
                                                          : &ready_.front().slices.front();
  }

  /// Gives up the first gap when it is time to; returns it. Then pop() again.
  std::optional<SliceGap> give_up_gap(Clock::time_point now, Outlook outlook);

  /// Slices, and corrections of them, that came and were not handed on.
  [[nodiscard]] std::int64_t num_waiting() const;

  /// Of these, bytes.
  [[nodiscard]] std::size_t waiting_bytes() const { return waiting_bytes_; }

  /// Ids below the largest seen that have not come.
  [[nodiscard]] std::int64_t num_missing() const;

  /// Of those, the ones nobody waits for any more.
  [[nodiscard]] std::int64_t num_given_up() const;

 private:
  void put(CloudSlice& place, CloudSlice slice);
  void make_ready(CloudSlice slice);
  Verdict correct(CloudSlice slice, Clock::time_point now);
  void take_turns();
  [[nodiscard]] bool may_grow(Clock::time_point now) const;

  Config config_;
  std::map<std::int32_t, CloudSlice> waiting_;  // for an earlier one, by id
  std::deque<SliceGroup> ready_;                // their turn has come
  std::int64_t num_ready_ = 0;                  // slices in ready_
  std::size_t waiting_bytes_ = 0;               // of waiting_ and ready_
  Revisions known_;                             // of slices whose turn has come
  std::int64_t next_id_ = 0;                    // the one to wait for
  std::int64_t end_id_ = 0;                     // one past the largest seen
  Clock::time_point last_progress_{};           // or since when something waits
  Clock::time_point first_correction_{};        // of the last run in ready_, if it is one
  Clock::time_point last_correction_{};
};

}  // namespace kintsugi::segmenter
