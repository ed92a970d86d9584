#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>

#include "mapper/core/frame/rgbd_frame.hpp"
#include "mapper/core/tracking/tracker.hpp"
#include "mapper/process/frame_timings.hpp"

namespace kintsugi::mapper {

/// A CSV file with a line for each frame: its tracking result and its times.
///
/// Each line is written at once, so that a crash loses none. When a line cannot be written (full
/// disk), an error is logged, the file keeps the lines before it, and no more lines are written.
class FrameLog {
 public:
  /// Creates or truncates the file and writes the header.
  /// @throws std::runtime_error naming the file and the reason when it cannot be written
  explicit FrameLog(const std::filesystem::path& path);

  /// @param part of the map, from 0
  /// @param num_slices published with this frame
  void append(const RgbdFrame& frame, int part, const TrackingResult& tracking, bool is_fused,
              std::size_t num_slices, const FrameTimings& timings);

  /// Lines are missing at the end of the file.
  [[nodiscard]] bool failed() const { return !out_; }

 private:
  std::filesystem::path path_;
  std::ofstream out_;
};

}  // namespace kintsugi::mapper
