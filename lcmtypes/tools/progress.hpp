#pragma once
// The progress of a run, from the statuses of its processes.

#include <cstdint>
#include <optional>
#include <set>
#include <string>

#include "lcmtypes/statuses.hpp"

namespace kintsugi {

/// The processes that a run need not have, and that are waited for only where it is said.
struct OptionalProcesses {
  bool viewer = false;
  bool detector = false;
};

/// The newest status of each process that works on one map. `now_us` is the caller's clock in
/// microseconds.
class Progress {
 public:
  /// @param map_name empty: the map of the first mapper that sends a status
  explicit Progress(const std::string& map_name = "") {
    if (!map_name.empty()) map_name_ = map_name;
  }

  void update(const MapperStatus& status, std::int64_t now_us);
  void update(const SegmenterStatus& status, std::int64_t now_us);
  void update(const ViewerStatus& status, std::int64_t now_us);
  void update(const DetectorStatus& status, std::int64_t now_us);

  /// A status of any process was received.
  bool heard_anything() const { return mapper_ || segmenter_ || viewer_ || detector_; }

  /// Mapper and segmenter have finished the same session, and so have those of `waited`.
  bool finished(const OptionalProcesses& waited) const;

  /// The processes that have not finished, as text for a person; empty: all have.
  std::string unfinished(const OptionalProcesses& waited) const;

  /// When a counter last changed or a process finished; nothing before the first status.
  std::optional<std::int64_t> last_progress_us() const { return last_progress_us_; }

  /// Seconds until everything is mapped and segmented, at the present rates; nothing: unknown.
  std::optional<double> time_left_s() const;

  /// One line of text for a person: frames, state, slices, size of the log, segments, lag, rates,
  /// losses, restarts, problems, time left.
  std::string line(std::int64_t now_us) const;

 private:
  /// Sum of all counters that only grow during a run.
  std::int64_t work_done() const;
  void note_progress(std::int64_t now_us);

  bool is_watched(const std::string& map_name);
  /// A process that has not received any map yet has no map name, and counts as ours.
  bool is_of_other_map(const std::string& map_name) const {
    return map_name_ && !map_name.empty() && map_name != *map_name_;
  }
  std::string problems_text() const;

  std::optional<std::string> map_name_;
  std::set<std::string> other_maps_;
  std::optional<MapperStatus> mapper_;
  std::optional<SegmenterStatus> segmenter_;
  std::optional<ViewerStatus> viewer_;
  std::optional<DetectorStatus> detector_;
  int mapper_restarts_ = 0;  // runs after the first
  int segmenter_restarts_ = 0;
  int viewer_restarts_ = 0;
  int detector_restarts_ = 0;
  std::int64_t work_done_ = -1;
  std::int64_t last_heard_us_ = 0;
  std::optional<std::int64_t> last_progress_us_;
};

}  // namespace kintsugi
