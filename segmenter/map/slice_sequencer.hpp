#pragma once
// Puts slices into the order of their ids, on which segment ids and mode `voting` depend, and
// patches into batches.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

/// What is missing of one session: slices of the ids [first, last], or revisions.
struct SliceGap {
  std::int32_t first = 0;
  std::int32_t last = 0;
  /// > 0: no slice is missing, but the newest revisions of some are, by this sum of revisions.
  std::int64_t num_revisions = 0;

  bool operator==(const SliceGap&) const = default;
};

/// Slices for one run of the engine.
struct SliceGroup {
  /// One new slice, or a correction of the map, or revisions or patches by ascending id.
  std::vector<CloudSlice> slices;
  bool is_correction = false;
  /// Chunks of older revisions that came and are not needed: with this group in the map, there is a
  /// newer one of each.
  std::vector<SequenceRange> superseded{};
};

/// What is known about the rest of a stream.
enum class Outlook {
  kLive,    ///< missing slices are being sent again: wait for them
  kSilent,  ///< nobody sends: wait for SliceSequencer::Config::gap_timeout
  kEnded,   ///< no more slices will come
};

/// Memory of a slice.
inline std::size_t bytes_of(const CloudSlice& slice) {
  return sizeof(slice) + slice.points_W.size() * sizeof(CloudPoint) +
         slice.motions.size() * sizeof(PatchMotion);
}

/// Returns the slices of one session in groups for the engine: slices in the order of their ids,
/// from 0, and patches by batch.
///
/// A slice that is no patch waits while an earlier one is missing. The missing ones are given up
/// when the stream has ended, or when nobody sends them and there was no progress for
/// `gap_timeout`. Then the waiting slices up to the next gap become ready. A slice that comes after
/// it was given up is ready at once. The final slice waits in the same way until the sum of the
/// newest revisions is what it says.
///
/// A higher revision of a slice that is still waiting replaces it. A higher revision of a slice
/// that was ready before is a correction. Consecutive corrections form one group, so that a moved
/// part of a map is segmented once; for each slice the group has its newest revision. The group is
/// complete when a new slice becomes ready after it, when no correction has come for
/// `correction_quiet`, when it has waited for `gap_timeout`, or when the stream has ended. A
/// revision that is not newer than the known one is a duplicate.
///
/// Patches wait for no other slice, since nothing depends on the order of their ids; a new one and
/// a higher revision are treated alike. A batch is what comes up to the patch that ends it, in the
/// newest revisions. Where the end was lost, the next end counts, or the final slice, or a pause of
/// `correction_quiet` (where `is_live`; else of `gap_timeout`). A patch that comes after the end
/// of its own batch, known by its time, is a group of its own and waits for nothing.
///
/// A correction of the map is a group of its own that waits for nothing either.
///
/// So the groups and their order depend only on the order of arrival, unless a timeout ends or
/// `is_live`.
class SliceSequencer {
 public:
  using Clock = std::chrono::steady_clock;

  struct Config {
    /// Longer than a restart of the mapper, which takes a few seconds.
    std::chrono::milliseconds gap_timeout{10'000};  ///< > 0
    /// Longer than a rate-limited stream needs for a large slice, 3 MB at 10 MB/s.
    std::chrono::milliseconds correction_quiet{500};  ///< > 0
    /// It matters more to be up to date than to form the same groups again: complete batches that
    /// wait, because segmenting is behind, are popped as one group.
    bool is_live = false;

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
  /// The slices that are in a resumed map.
  struct Done {
    Revisions revisions;
    /// There are patches, which came in any order: smaller ids that are missing are still to come.
    /// Else they count as given up.
    bool has_patches = false;
  };

  /// @throws std::invalid_argument for an invalid config
  explicit SliceSequencer(const Config& config) : SliceSequencer(config, Done()) {}
  SliceSequencer(const Config& config, Done done);

  Verdict offer(CloudSlice slice, Clock::time_point now);

  /// Removes and returns the first complete group, if there is one.
  std::optional<SliceGroup> pop(Clock::time_point now, Outlook outlook);

  /// The new slice that the next pop() will return; nullptr when there is none, or when corrections
  /// or patches come first.
  [[nodiscard]] const CloudSlice* upcoming() const;

  /// Gives up the first gap, if it is time to, and returns it. Then pop() may return more.
  std::optional<SliceGap> give_up_gap(Clock::time_point now, Outlook outlook);

  /// The next group is a batch of patches whose end has not come.
  [[nodiscard]] bool is_in_batch() const;

  /// Slices and corrections that came and were not popped.
  [[nodiscard]] std::int64_t num_waiting() const;

  /// Their memory.
  [[nodiscard]] std::size_t waiting_bytes() const { return waiting_bytes_; }

  /// Slices with an id below the largest seen that have not come.
  [[nodiscard]] std::int64_t num_missing() const;

  /// Those of them that were given up; 1 when none were, but revisions.
  [[nodiscard]] std::int64_t num_given_up() const;

 private:
  enum class Kind : std::uint8_t { kNewSlice, kCorrections, kPatches, kMotions };
  struct Group {
    Kind kind = Kind::kNewSlice;
    bool is_closed = true;  ///< nothing is added any more
    std::map<std::int32_t, CloudSlice> slices{};
    std::vector<SequenceRange> superseded{};
  };

  Verdict take_patch(CloudSlice slice, Clock::time_point now);
  Verdict take_motions(CloudSlice slice);
  Verdict correct(CloudSlice slice, Clock::time_point now);
  Verdict wait(CloudSlice slice, Clock::time_point now);
  Group& open_group(Kind kind, Clock::time_point now);
  void put(Group& group, CloudSlice slice);
  void merge_batches(Group& group);
  void drop(const CloudSlice& slice);
  void supersede(const CloudSlice& slice, std::vector<SequenceRange>& superseded) const;
  void learn(const CloudSlice& slice);
  void skip_known();
  void make_ready(CloudSlice slice);
  void take_turns();
  [[nodiscard]] std::int64_t num_revisions_missing(const CloudSlice& slice) const;
  [[nodiscard]] bool may_grow(const Group& group, Clock::time_point now) const;

  Config config_;
  std::map<std::int32_t, CloudSlice> waiting_;  // for an earlier slice or revision, by id
  std::deque<Group> ready_;                     // the last one perhaps not complete
  std::int64_t num_ready_ = 0;                  // slices in ready_
  std::size_t waiting_bytes_ = 0;               // of waiting_ and ready_
  Revisions known_;                             // of slices that are ready, or were
  std::int64_t revision_sum_ = 0;               // of known_
  std::int64_t next_id_ = 0;       // the id to wait for: smaller ones are known or given up
  std::int64_t end_id_ = 0;        // one past the largest id seen
  std::int64_t num_given_up_ = 0;  // slices
  std::int64_t given_up_revision_sum_ = 0;   // of the final slice that no longer waits for it
  std::int64_t last_end_utime_ = INT64_MIN;  // of the newest batch that has ended
  std::vector<SequenceRange> superseded_;    // by what was popped
  Clock::time_point last_progress_{};        // or when a slice began to wait
  Clock::time_point first_arrival_{};        // in the last group of ready_, if it is open
  Clock::time_point last_arrival_{};
};

}  // namespace kintsugi::segmenter
