#pragma once
// All statuses of a run in a CSV file, for programs that compare runs.

#include <filesystem>
#include <string>

#include "lcmtypes/statuses.hpp"

namespace kintsugi {

/// A CSV file `utime_us,process,field,value` with a line for each field of each status. The field
/// has its name on the bus; a boolean is 1 or 0, a text is between double quotes. While the disk is
/// full statuses are left out: each one is in the file completely, or not at all.
class StatusLog {
 public:
  /// Appends to the file if it exists. @throws std::runtime_error when it cannot be written
  explicit StatusLog(const std::filesystem::path& path);

  /// Status: MapperStatus, SegmenterStatus, ViewerStatus or DetectorStatus.
  template <class Status>
  void append(const Status& status);

 private:
  bool write(const std::string& text) const;

  std::filesystem::path path_;
};

}  // namespace kintsugi
