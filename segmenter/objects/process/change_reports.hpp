#pragma once
// What was reported of the changes of a running map, so that each keeps its number.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "lcmtypes/object_messages.hpp"
#include "segmenter/objects/changes/map_changes.hpp"

namespace kintsugi::segmenter {

/// The running map, as it was compared.
struct ReportedMap {
  std::int64_t utime = 0;  ///< device time of the newest slice, microseconds
  std::int64_t map_session = 0;
  std::string map_name;
};

/// One session of reports on one map session.
class ChangeReports {
 public:
  /// Of those that were withdrawn the newest so many are kept: in a long session more and more are,
  /// all are repeated, and who comes late needs none of them.
  static constexpr std::size_t kMaxWithdrawn = 100;

  /// @param before name of the earlier map
  ChangeReports(std::int64_t session, std::string before)
      : session_(session), before_(std::move(before)) {}

  /// Takes what differs now. A change that was there before, at the same place, keeps its number;
  /// what is no longer so is withdrawn. Whatever is not as it was reported is an event. What was
  /// withdrawn by this call is kept until the next one at least, so that it can be told.
  void update(const MapChanges& now, const ReportedMap& map);

  /// By number; with their last events.
  [[nodiscard]] const std::vector<ChangeReport>& reports() const { return reports_; }
  [[nodiscard]] std::int64_t num_events() const { return num_events_; }

 private:
  void forget_withdrawn();

  std::int64_t session_;
  std::string before_;
  std::vector<ChangeReport> reports_;
  std::int32_t num_changes_ = 0;  // all of the session
  std::int64_t num_events_ = 0;
};

}  // namespace kintsugi::segmenter
