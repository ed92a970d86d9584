#pragma once
// One map for each mapper session on the bus.

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "lcmtypes/base/swap_space.hpp"
#include "segmenter/session/session_map.hpp"

namespace kintsugi::segmenter {

/// What may still arrive of the slices of a session.
struct StreamState {
  Outlook outlook = Outlook::kSilent;  ///< never kEnded
  bool is_quiet = false;  ///< true: nothing is missing, or nobody sends it, so the session can end
};

/// Gives each slice to the map of its session. Belongs to one thread; knows neither bus nor files.
///
/// Maps of different names are kept side by side. Of two sessions with one name, the newer (the
/// larger number) owns the name and the older is superseded: it still receives its own slices, and
/// the two maps are never mixed. When nothing of a superseded session is missing and nothing new
/// has arrived for Config::settle, a save of its map is requested and the session is forgotten. Two
/// mappers that run under one name at the same time therefore make two maps until the
/// older pauses; a warning says that each needs a name. Slices of forgotten sessions are dropped
/// and counted.
class SessionMaps {
 public:
  using Clock = SessionMap::Clock;

  struct Config {
    SegmentMapConfig map;
    SessionMap::Config each_map;
    std::string map_name;       ///< only the map of this name; empty: all
    std::size_t max_maps = 64;  ///< at the same time, >= 1; slices of further sessions are dropped
    /// Ten heartbeats: enough to hear a mapper that resumes its session or still resends it. >= 0
    std::chrono::milliseconds settle{2'000};

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };

  /// What has happened so far.
  struct Counts {
    SessionMap::Counts newest;      ///< of the map of the newest session
    std::int64_t maps = 0;          ///< that are kept
    std::int64_t lag = 0;           ///< of all maps
    std::int64_t missing = 0;       ///< slices, of all maps, also of forgotten ones
    std::int64_t dropped = 0;       ///< slices
    std::size_t waiting_bytes = 0;  ///< of slices that wait to be segmented
    bool in_batch = false;          ///< in some map a batch of patches waits for its end
    bool complete = false;          ///< every map is complete, and none is superseded
    bool ended = false;             ///< every map has ended, and none is superseded
  };

  /// @param session of this segmenter
  /// @param stream_state of a mapper session, given by its number
  /// @param swap for what the maps do not use for long, must outlive them; null: all in memory
  /// @throws std::invalid_argument for an invalid config
  SessionMaps(const Config& config, std::int64_t session,
              std::function<StreamState(std::int64_t)> stream_state, SwapSpace* swap = nullptr);

  /// Resumes a saved map; call before the first offer().
  void resume(std::unique_ptr<SegmentMap> map);

  /// Accepts a slice in any order of arrival. Returns warnings for the user.
  std::vector<std::string> offer(CloudSlice slice, Clock::time_point now);

  /// Does one step (SessionMap::step()) of one map, the maps in turn, and ends at most one
  /// superseded session.
  /// @throws what the engine throws; afterwards only save() may be called
  [[nodiscard]] StepResult step(Clock::time_point now);

  /// No more slices will arrive: further steps segment everything, gaps or not, and then end the
  /// superseded sessions.
  void close() { is_closed_ = true; }

  /// A request for each map that has changed since its last one; `again`: for each map.
  [[nodiscard]] std::vector<SaveRequest> save(bool again = false);

  /// The full state of all maps: one update for each slice.
  std::vector<SegmentUpdate> describe() const;

  Counts counts() const;
  /// All maps, older sessions first.
  std::vector<const SegmentMap*> maps() const;

 private:
  struct Session {
    SessionMap map;
    Clock::time_point last_news;  // when it was last certain that it continues
  };
  using Sessions = std::map<std::int64_t, Session>;
  using Warnings = std::vector<std::string>;

  Session* find_or_begin(const CloudSlice& slice, Clock::time_point now, Warnings& warnings);
  Session& begin(std::unique_ptr<SegmentMap> map, Clock::time_point now);
  void supersede(const SegmentMap& map, Clock::time_point now, Warnings& warnings);
  bool is_superseded(const SegmentMap& map) const;
  StepResult step_next(Clock::time_point now);
  void end_superseded(Clock::time_point now, StepResult& result);
  bool can_end(std::int64_t number, Session& session, Clock::time_point now) const;
  void end(Sessions::iterator session, StepResult& result);
  void add_request(SaveRequest request, std::vector<SaveRequest>& requests) const;
  void drop(std::int32_t id, std::int64_t map_session, const std::string& why, Warnings& warnings);

  Config config_;
  std::int64_t session_;
  std::function<StreamState(std::int64_t)> stream_state_;
  SwapSpace* swap_;
  Sessions sessions_;                      // by number
  std::int64_t last_stepped_session_ = 0;  // the next step begins with the one after it
  bool is_closed_ = false;
  std::set<std::int64_t> forgotten_;
  std::int64_t num_dropped_ = 0;
  std::int64_t num_missing_ = 0;  // of forgotten sessions
};

}  // namespace kintsugi::segmenter
