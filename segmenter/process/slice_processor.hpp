#pragma once
// From slices as they arrive to segment updates and map files.

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/map/segment_map.hpp"
#include "segmenter/map/slice_sequencer.hpp"

namespace kintsugi::segmenter {

/// Keeps the map of the current mapper session: puts slices in order, segments them, hands out one
/// update for each. Belongs to one thread; knows neither bus nor files.
///
/// A slice of a new session ends the current map: what waits is segmented, the map is handed to
/// `save`, a new one begins. Slices of a session that has ended are dropped and counted. Two
/// mappers that run at the same time are told apart by Config::map_name.
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
    SegmentMapConfig map;
    SliceSequencer::Config order;
    std::string map_name;   ///< only slices of this map; empty: any
    bool coalesce = false;  ///< mode `batch`: one run for all slices that are ready
    int write_every = 0;    ///< save after so many slices; 0: only at the end, or when asked

    /// Throws std::invalid_argument naming field, value and bound.
    void validate() const;
  };

  /// Why a map is saved, and so under which name.
  enum class Save {
    kCurrent,
    kSessionEnded,
    kBroken,  ///< segmenting failed half way: good to look at, not to go on with
  };

  /// Called from the thread that calls this; what they do delays the next slice.
  struct Outputs {
    std::function<void(SegmentUpdate update)> publish;
    std::function<void(const SegmentMap& map, Save why)> save;
    std::function<void(const std::string& text)> warn;
  };

  /// What has happened so far, over all sessions unless it says otherwise.
  struct Counts {
    std::int64_t map_session = 0;  ///< of the current map; 0: none yet
    std::string map_name;          ///< of the current map
    std::int64_t received = 0;     ///< slices of the current session, each once
    std::int64_t segmented = 0;    ///< of those
    std::int64_t corrected = 0;    ///< higher revisions that were segmented, in this session
    std::int64_t lag = 0;          ///< received, revisions too, or known to exist; not segmented
    std::int64_t points = 0;       ///< in the current map
    std::int64_t rejected = 0;     ///< points turned away by the current map
    std::int64_t segments = 0;     ///< in the current map
    std::int64_t missing = 0;      ///< slices given up in the current session, and not come since
    std::int64_t dropped = 0;      ///< slices of ended sessions or other resolutions
    bool complete = false;         ///< the final slice and every earlier one are segmented
    bool ended = false;            ///< complete, or the final slice is and the missing are given up
    double slice_ms = 0.0;         ///< of the last slice; a run's time is shared by its slices
    double slice_mean_ms = 0.0;    ///< of the current session
    double slice_max_ms = 0.0;     ///< of the current session
  };

  /// @param session of this segmenter
  /// @throws std::invalid_argument for an invalid config
  SliceProcessor(const Config& config, std::int64_t session, Outputs outputs);

  /// Goes on with a map that was kept; call before the first offer(). Publishes what is in it, for
  /// listeners know nothing of this segmenter session.
  void resume(std::unique_ptr<SegmentMap> map);

  /// Takes a slice in any order of arrival.
  void offer(CloudSlice slice, Clock::time_point now);

  /// Segments what is ready, at most one run. Returns false when there was nothing to do. Throws
  /// what the engine throws; then only save() may follow.
  bool step(Clock::time_point now);

  /// No more slices will come: segments all that is there, gaps or not.
  void finish(Clock::time_point now);

  /// Saves the current map, unless it has been saved as it is; with `again`, even so.
  void save(bool again = false);

  [[nodiscard]] const Counts& counts() const { return counts_; }
  [[nodiscard]] const SegmentMap* map() const { return map_.get(); }

 private:
  [[nodiscard]] bool is_wanted(const CloudSlice& slice);
  void drop(const CloudSlice& slice, const std::string& why);
  void begin_session(const CloudSlice& first);
  void end_session(Clock::time_point now);
  bool step(Clock::time_point now, bool stream_has_ended);
  [[nodiscard]] std::vector<CloudSlice> take_ready(Clock::time_point now, bool stream_has_ended);
  void segment(const std::vector<CloudSlice>& slices);
  void count_run(std::int64_t num_new, std::int64_t num_corrected, double run_ms);
  void count_map();

  Config config_;
  std::int64_t session_;
  Outputs outputs_;
  std::unique_ptr<SegmentMap> map_;
  std::optional<SliceSequencer> sequencer_;  // there is one iff there is a map
  std::set<std::int64_t> ended_sessions_;
  bool is_saved_ = true;
  bool is_broken_ = false;           // the engine has failed half way
  std::int64_t num_since_save_ = 0;  // slices since saving was tried
  std::int64_t num_timed_ = 0;       // slices in the runs of this session, and their time
  double total_ms_ = 0.0;
  Counts counts_;
};

}  // namespace kintsugi::segmenter
