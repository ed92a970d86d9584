#pragma once
// The segment map of one mapper session, made of its slices as they arrive.

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/map/segment_map.hpp"
#include "segmenter/map/slice_sequencer.hpp"

namespace kintsugi::segmenter {

/// Which files a map is to be written into.
enum class SaveKind : std::uint8_t {
  kCurrent,       ///< the map files (segments.*) and the saved map (--save)
  kForResume,     ///< the saved map only
  kSessionEnded,  ///< the map files only, under the number of the session: its name is taken
  kBroken,        ///< the map files only: segmenting failed half way, so nobody can resume this map
};

struct SaveRequest {
  std::shared_ptr<const SegmentMap> map;  ///< unchanged until the next step
  SaveKind kind = SaveKind::kCurrent;
};

/// The result of one step: what is to be published, then written, and what the user should know.
struct StepResult {
  bool has_progressed = false;  ///< false: there was nothing to do
  std::vector<SegmentUpdate> updates;
  std::vector<SaveRequest> saves;
  std::vector<std::string> warnings;
  std::optional<std::int64_t> ended_session;  ///< no more slices of it are wanted
};

/// Puts the slices of one mapper session in order and segments them; one update for each slice.
/// Belongs to one thread; knows neither bus nor files.
///
/// One step segments what SliceSequencer groups: a new slice, corrections that arrived together, or
/// a batch of patches. The same slices therefore give the same ids, whenever they arrive, except
/// with SliceSequencer::Config::is_live. With Config::coalesce, mode `batch` segments everything
/// that is ready in one step. The partition after it is the same, but segment ids may be numbered
/// differently, because they depend on the history of the steps and so on timing.
class SessionMap {
 public:
  using Clock = SliceSequencer::Clock;

  struct Config {
    SliceSequencer::Config order;
    bool coalesce = false;  ///< mode `batch`: one run of the engine for all slices that are ready
    /// SaveKind::kCurrent after so many slices, >= 0; 0: only when complete. A batch counts as one.
    int write_every = 0;
    int save_every = 0;  ///< SaveKind::kForResume in the same way; 0: never

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };

  /// What has happened so far.
  struct Counts {
    std::int64_t map_session = 0;
    std::string map_name;
    std::int64_t received = 0;   ///< slices, each once
    std::int64_t segmented = 0;  ///< of those
    std::int64_t corrected = 0;  ///< higher revisions that were segmented
    std::int64_t lag = 0;     ///< slices and revisions, received or known to exist, to be segmented
    std::int64_t points = 0;  ///< in the map
    std::int64_t rejected = 0;  ///< points that the map did not accept
    std::int64_t segments = 0;  ///< in the map
    std::int64_t missing = 0;   ///< slices given up that have not arrived since
    bool complete = false;      ///< SegmentMap::is_complete()
    bool ended = false;         ///< complete, or the final slice is and the missing are given up
    double slice_ms = 0.0;      ///< of the last slice; the time of a step is shared by its slices
    double slice_mean_ms = 0.0;
    double slice_max_ms = 0.0;
  };

  /// @param map an empty one, or one to resume: slices in it are not segmented again
  /// @throws std::invalid_argument for an invalid config
  SessionMap(const Config& config, std::unique_ptr<SegmentMap> map);
  SessionMap(SessionMap&&) = default;  // no copies: they would share the map
  SessionMap& operator=(SessionMap&&) = default;

  /// Accepts a slice of the map's session in any order of arrival. Returns the reason when it is
  /// dropped; nothing when it is accepted or a duplicate.
  std::optional<std::string> offer(CloudSlice slice, Clock::time_point now);

  /// Segments what is ready, with at most one run of the engine, or gives up a gap. With
  /// Outlook::kEnded, repeated steps segment everything, gaps or not.
  /// @throws what the engine throws; afterwards only save() may be called
  [[nodiscard]] StepResult step(Clock::time_point now, Outlook outlook);

  /// A request to save the map, unless it has not changed since the last one; `again`: in any case.
  [[nodiscard]] std::optional<SaveRequest> save(bool again = false);

  const Counts& counts() const { return counts_; }
  const SegmentMap& segment_map() const { return *map_; }
  std::shared_ptr<const SegmentMap> shared_segment_map() const { return map_; }
  /// True when no slice that arrived waits to be segmented.
  bool is_idle() const { return sequencer_.num_waiting() == 0; }
  /// True when a batch of patches waits for its end.
  bool is_in_batch() const { return sequencer_.is_in_batch(); }
  /// Memory of the slices that arrived and are not segmented.
  std::size_t waiting_bytes() const { return sequencer_.waiting_bytes(); }

 private:
  std::vector<CloudSlice> take_ready(Clock::time_point now, Outlook outlook);
  std::vector<SegmentUpdate> segment(const std::vector<CloudSlice>& slices);
  std::optional<SaveRequest> save_when_due(std::int64_t num_slices);
  void count_run(std::int64_t num_new, std::int64_t num_corrected, double run_ms);
  void count_map();

  Config config_;
  std::shared_ptr<SegmentMap> map_;
  SliceSequencer sequencer_;
  bool is_saved_;                     // not a map that is resumed: its files may be older
  bool is_broken_ = false;            // the engine has failed half way
  std::int64_t num_since_write_ = 0;  // slices since the last request of kind kCurrent
  std::int64_t num_since_save_ = 0;   // slices since the last request of either kind
  std::int64_t num_timed_ = 0;        // slices in the runs, and their time
  double total_ms_ = 0.0;
  Counts counts_;
};

}  // namespace kintsugi::segmenter
