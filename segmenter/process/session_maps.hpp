#pragma once
// A map for each mapper session on the bus.

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "segmenter/process/slice_processor.hpp"

namespace kintsugi::segmenter {

/// What is known of the stream that brings the slices. Called from the thread of SessionMaps.
struct SliceStream {
  /// What may still come of a session; not kEnded.
  std::function<Outlook(std::int64_t map_session)> outlook;
  /// Nothing of a session is missing, or nobody sends it: it is over once nothing new comes.
  std::function<bool(std::int64_t map_session)> is_quiet;
  /// Nothing of a session is wanted any more.
  std::function<void(std::int64_t map_session)> forget;
};

/// Gives each slice to the map of its session. Belongs to one thread; knows neither bus nor files.
///
/// Maps of different names live side by side. Of two sessions of one name the newer (the larger
/// number) has the name; the older is superseded: it still gets what was published of it, beside
/// the new one and never mixed with it, and when nothing of it is missing and nothing new has come
/// for Config::settle it is handed to `save` and forgotten. So two mappers that run under one name
/// at the same time make two maps, until the older pauses: it is told that they need names.
/// Slices of sessions that were forgotten are dropped and counted.
class SessionMaps {
 public:
  using Clock = SliceProcessor::Clock;
  using Save = SliceProcessor::Save;

  struct Config {
    SegmentMapConfig map;
    SliceProcessor::Config processor;
    std::string map_name;       ///< only the map of this name; empty: all
    std::size_t max_maps = 64;  ///< at a time; slices of more are dropped; >= 1
    /// Ten heartbeats: a mapper that went on with its session, or serves it still, was heard.
    std::chrono::milliseconds settle{2'000};  ///< >= 0

    /// Throws std::invalid_argument naming field, value and bound.
    void validate() const;
  };

  /// What has happened so far.
  struct Counts {
    SliceProcessor::Counts newest;  ///< of the map of the newest session
    std::int64_t maps = 0;          ///< being kept
    std::int64_t lag = 0;           ///< of all maps
    std::int64_t missing = 0;       ///< slices, of all maps, those forgotten too
    std::int64_t dropped = 0;       ///< slices
    std::size_t waiting_bytes = 0;  ///< of slices that wait to be segmented
    bool complete = false;          ///< every map is, and none is superseded
    bool ended = false;             ///< likewise
  };

  /// @param session of this segmenter
  /// @throws std::invalid_argument for an invalid config
  SessionMaps(const Config& config, std::int64_t session, SliceStream stream,
              SliceProcessor::Outputs outputs);

  SessionMaps(const SessionMaps&) = delete;  // its processors refer to it
  SessionMaps& operator=(const SessionMaps&) = delete;

  /// Goes on with a map that was kept; call before the first offer().
  void resume(std::unique_ptr<SegmentMap> map);

  /// Takes a slice in any order of arrival.
  void offer(CloudSlice slice, Clock::time_point now);

  /// Segments what is ready, at most one run of each map, and ends what is over. Returns false
  /// when there was nothing to do. Throws what the engine throws; then only save() may follow.
  bool step(Clock::time_point now);

  /// No more slices will come: segments all that is there, gaps or not, ends superseded maps.
  void finish(Clock::time_point now);

  /// Saves every map that has not been saved as it is; with `again`, all.
  void save(bool again = false);

  /// All maps for a listener that knows nothing of them, one update for each slice.
  [[nodiscard]] std::vector<SegmentUpdate> describe() const;

  [[nodiscard]] Counts counts() const;
  /// All maps, the older sessions first.
  [[nodiscard]] std::vector<const SegmentMap*> maps() const;
  /// The map of a session; null: none.
  [[nodiscard]] const SegmentMap* map(std::int64_t map_session) const;

 private:
  struct Session {
    SliceProcessor processor;
    Clock::time_point last_news;  // when it was last certain that it goes on
  };
  using Sessions = std::map<std::int64_t, Session>;

  Session* find_or_begin(const CloudSlice& slice, Clock::time_point now);
  Session& begin(std::unique_ptr<SegmentMap> map, Clock::time_point now);
  void supersede(const SegmentMap& map, Clock::time_point now);
  [[nodiscard]] bool is_superseded(const SegmentMap& map) const;
  bool end_superseded(Clock::time_point now);
  void end(Sessions::iterator session);
  void save(const SegmentMap& map, Save why);
  void drop(std::int32_t id, std::int64_t map_session, const std::string& why);

  Config config_;
  std::int64_t session_;
  SliceStream stream_;
  SliceProcessor::Outputs outputs_;
  Sessions sessions_;  // by number
  std::set<std::int64_t> forgotten_;
  std::int64_t num_dropped_ = 0;
  std::int64_t num_missing_ = 0;  // of forgotten sessions
};

}  // namespace kintsugi::segmenter
