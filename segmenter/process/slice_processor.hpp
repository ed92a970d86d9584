#pragma once
// From the slices of one mapper session, as they arrive, to segment updates and map files.

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/map/segment_map.hpp"
#include "segmenter/map/slice_sequencer.hpp"

namespace kintsugi::segmenter {

/// Keeps the map of one mapper session: puts slices in order, segments them, hands out one update
/// for each. Belongs to one thread; knows neither bus nor files.
///
/// What SliceSequencer puts into a run is segmented in one: a new slice, or corrections that came
/// together. So the same slices give the same ids, whenever they arrive. With Config::coalesce,
/// mode `batch` segments everything that is ready in one run. The partition after it is the same,
/// but the segment ids may be numbered differently: they tell the history of the runs, which then
/// depends on timing.
class SliceProcessor {
 public:
  using Clock = SliceSequencer::Clock;

  struct Config {
    SliceSequencer::Config order;
    bool coalesce = false;  ///< mode `batch`: one run for all slices that are ready
    int write_every = 0;    ///< write after so many slices; 0: only at the end, or when asked
    int save_every = 0;     ///< save for going on after so many slices; 0: as write_every

    /// Throws std::invalid_argument naming field, value and bound.
    void validate() const;
  };

  /// Why a map is saved, and so what of it.
  enum class Save {
    kCurrent,       ///< to look at and to go on with
    kToGoOn,        ///< only that
    kSessionEnded,  ///< its place is taken by another
    kBroken,        ///< segmenting failed half way: good to look at, not to go on with
  };

  /// Called from the thread that calls this; what they do delays the next slice.
  struct Outputs {
    std::function<void(SegmentUpdate update)> publish;
    std::function<void(const SegmentMap& map, Save why)> save;
    std::function<void(const std::string& text)> warn;
  };

  /// What has happened so far.
  struct Counts {
    std::int64_t map_session = 0;
    std::string map_name;
    std::int64_t received = 0;   ///< slices, each once
    std::int64_t segmented = 0;  ///< of those
    std::int64_t corrected = 0;  ///< higher revisions that were segmented
    std::int64_t lag = 0;        ///< received, revisions too, or known to exist; not segmented
    std::int64_t points = 0;     ///< in the map
    std::int64_t rejected = 0;   ///< points turned away by the map
    std::int64_t segments = 0;   ///< in the map
    std::int64_t missing = 0;    ///< slices given up, and not come since
    bool complete = false;       ///< the final slice and every earlier one are segmented
    bool ended = false;          ///< complete, or the final slice is and the missing are given up
    double slice_ms = 0.0;       ///< of the last slice; a run's time is shared by its slices
    double slice_mean_ms = 0.0;
    double slice_max_ms = 0.0;
  };

  /// @param map to begin with, empty; or to go on with: what it has is not segmented again
  /// @throws std::invalid_argument for an invalid config
  SliceProcessor(const Config& config, std::unique_ptr<SegmentMap> map, Outputs outputs);

  /// Takes a slice of the map's session in any order of arrival. Returns why it is dropped;
  /// nothing when it is taken or there already.
  std::optional<std::string> offer(CloudSlice slice, Clock::time_point now);

  /// Segments what is ready, at most one run. Returns false when there was nothing to do. Throws
  /// what the engine throws; then only save() may follow.
  bool step(Clock::time_point now, Outlook outlook);

  /// No more slices will come: segments all that is there, gaps or not.
  void finish(Clock::time_point now);

  /// Saves the map, unless it has been saved as it is; with `again`, even so.
  void save(bool again = false);

  [[nodiscard]] const Counts& counts() const { return counts_; }
  [[nodiscard]] const SegmentMap& map() const { return *map_; }
  /// Nothing that came waits to be segmented.
  [[nodiscard]] bool is_idle() const { return sequencer_.num_waiting() == 0; }
  /// Of slices that came and are not segmented.
  [[nodiscard]] std::size_t waiting_bytes() const { return sequencer_.waiting_bytes(); }

 private:
  [[nodiscard]] std::vector<CloudSlice> take_ready(Clock::time_point now, Outlook outlook);
  void segment(const std::vector<CloudSlice>& slices);
  void save_when_due(std::int64_t num_slices);
  void count_run(std::int64_t num_new, std::int64_t num_corrected, double run_ms);
  void count_map();

  Config config_;
  Outputs outputs_;
  std::unique_ptr<SegmentMap> map_;
  SliceSequencer sequencer_;
  bool is_saved_ = true;
  bool is_broken_ = false;            // the engine has failed half way
  std::int64_t num_since_write_ = 0;  // slices since saving was tried: all of it
  std::int64_t num_since_save_ = 0;   // any of it
  std::int64_t num_timed_ = 0;        // slices in the runs, and their time
  double total_ms_ = 0.0;
  Counts counts_;
};

}  // namespace kintsugi::segmenter
