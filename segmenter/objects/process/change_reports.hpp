#pragma once
// What was reported of the changes of a running map, so that each keeps its number.

#include <cstdint>
#include <string>
#include <vector>

#include "lcmtypes/object_messages.hpp"
#include "segmenter/objects/changes/map_changes.hpp"

namespace kintsugi::segmenter {

/// The running map, as it was compared.
struct ComparedMap {
  std::int64_t utime = 0;  ///< device time of the newest slice, microseconds
  std::int64_t map_session = 0;
  std::string map_name;
};

/// One session of reports on one map session.
class ChangeReports {
 public:
  /// @param before name of the earlier map
  ChangeReports(std::int64_t session, std::string before)
      : session_(session), before_(std::move(before)) {}

  /// Takes what differs now. A change that was there before, at the same place, keeps its number;
  /// what is no longer so is withdrawn. Whatever is not as it was reported is an event.
  void update(const MapChanges& now, const ComparedMap& map);

  /// By number; all of the session, with their last events.
  [[nodiscard]] const std::vector<ChangeReport>& reports() const { return reports_; }
  [[nodiscard]] std::int64_t num_events() const { return num_events_; }

 private:
  std::int64_t session_;
  std::string before_;
  std::vector<ChangeReport> reports_;
  std::int64_t num_events_ = 0;
};

}  // namespace kintsugi::segmenter
