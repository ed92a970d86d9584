#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>

#include "mapper/core/frame/rgbd_frame.hpp"
#include "mapper/core/tracking/tracker.hpp"
#include "mapper/process/frame_timings.hpp"

namespace kintsugi::mapper {

/// A CSV file with a line for each frame: what became of it and what it cost.
///
/// Lines are written as frames come, so that a crash loses none. When one cannot be written (a full
/// disk), that is logged, the file stays as it is, and the run goes on without it.
class FrameLog {
 public:
  /// Empties the file and writes the header.
  /// @throws std::runtime_error naming file and reason when that is not possible
  explicit FrameLog(const std::filesystem::path& path);

  /// @param num_slices handed out with this frame
  void append(const RgbdFrame& frame, const TrackingResult& tracking, std::size_t num_slices,
              const FrameTimings& timings);

 private:
  std::filesystem::path path_;
  std::ofstream out_;
};

}  // namespace kintsugi::mapper
