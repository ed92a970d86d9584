#pragma once
// All statuses of a run in a CSV file, for programs that compare runs.

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "lcmtypes/statuses.hpp"

namespace kintsugi {

/// A CSV file `utime_us,process,field,value` with a line for each field of each status. The field
/// has its name on the bus; a boolean is 1 or 0, a text is between double quotes. While the disk is
/// full statuses are left out: each one is in the file completely, or not at all. With a period the
/// file has of each process the first status, then one of each period, and the last one.
class StatusLog {
 public:
  /// Appends to the file if it exists. @throws std::runtime_error when it cannot be written, or is
  ///   another kind of file
  explicit StatusLog(const std::filesystem::path& path, double period_s = 0.0);
  ~StatusLog();
  StatusLog(const StatusLog&) = delete;
  StatusLog& operator=(const StatusLog&) = delete;

  /// Status: MapperStatus, SegmenterStatus, ViewerStatus or DetectorStatus.
  template <class Status>
  void append(const Status& status);

 private:
  struct Process {
    std::int64_t written_utime = INT64_MIN;  ///< of the last status in the file
    std::string waiting;                     ///< the lines of the newest one; empty: they are there
  };

  bool write(const std::string& text) const;

  std::filesystem::path path_;
  double period_us_;
  std::map<std::string, Process> processes_;
};

}  // namespace kintsugi
