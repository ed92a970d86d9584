#pragma once
// Every status of a run in a file, for programs that compare runs.

#include <cstdint>
#include <filesystem>
#include <fstream>

#include "lcmtypes/messages.hpp"

namespace kintsugi {

/// A CSV file `utime_us,process,field,value`: a line for each number in each status, and for what
/// is a problem, with the name it has on the bus; yes and no are 1 and 0.
class StatusLog {
 public:
  /// Goes on with the file when it is there. Throws std::runtime_error when it cannot be written.
  explicit StatusLog(const std::filesystem::path& path);

  void append(const MapperStatus& status);
  void append(const SegmenterStatus& status);
  void append(const ViewerStatus& status);

 private:
  std::ofstream out_;
};

}  // namespace kintsugi
