#pragma once
// What the status messages of a run say about how far it is.

#include <cstdint>
#include <optional>
#include <set>
#include <string>

#include "lcmtypes/messages.hpp"

namespace kintsugi {

/// The newest status of each process that works on one map. Times `now_us` are the caller's,
/// microseconds.
class Progress {
 public:
  /// `map_name` empty: the map that a mapper is heard of first.
  explicit Progress(const std::string& map_name = "") {
    if (!map_name.empty()) map_name_ = map_name;
  }

  void update(const MapperStatus& status, std::int64_t now_us);
  void update(const SegmenterStatus& status, std::int64_t now_us);
  void update(const ViewerStatus& status, std::int64_t now_us);

  bool heard_anything() const { return mapper_ || segmenter_ || viewer_; }

  /// Mapper and segmenter of one session, and the viewer if asked for, have said so.
  bool finished(bool with_viewer) const;

  /// Who has not finished: for a person.
  std::string unfinished(bool with_viewer) const;

  /// When a counter last moved, or a process finished; nothing before anything was heard.
  std::optional<std::int64_t> last_progress_us() const { return last_progress_us_; }

  /// Seconds until all is mapped and segmented, at the present rates; nothing when not known.
  std::optional<double> time_left_s() const;

  /// One line for a person: frames, state, slices, store, segments, lag, rates, losses, restarts,
  /// problems, time left.
  std::string line(std::int64_t now_us) const;

 private:
  /// Sum of everything that counts up in a run.
  std::int64_t work_done() const;
  void note_progress(std::int64_t now_us);

  bool is_watched(const std::string& map_name);
  /// A segmenter or viewer that has not heard of a map yet is of any.
  bool is_of_other_map(const std::string& map_name) const {
    return map_name_ && !map_name.empty() && map_name != *map_name_;
  }
  std::string problems_text() const;

  std::optional<std::string> map_name_;
  std::set<std::string> other_maps_;
  std::optional<MapperStatus> mapper_;
  std::optional<SegmenterStatus> segmenter_;
  std::optional<ViewerStatus> viewer_;
  int mapper_restarts_ = 0;  // as new sessions
  int segmenter_restarts_ = 0;
  int viewer_restarts_ = 0;
  std::int64_t work_done_ = -1;
  std::int64_t last_heard_us_ = 0;
  std::optional<std::int64_t> last_progress_us_;
};

}  // namespace kintsugi
