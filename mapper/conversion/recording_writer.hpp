#pragma once

#include <filesystem>
#include <memory>

#include "lcmtypes/trajectory.hpp"
#include "mapper/core/frame/rgbd_frame.hpp"

namespace kintsugi::mapper {

/// Writes a recording frame by frame. What it is called appears with finish(), complete; before
/// that, and without it, there is only something with `.partial` in its name, which goes away.
class RecordingWriter {
 public:
  virtual ~RecordingWriter() = default;

  /// Frames come by ascending time, all of one camera.
  /// @throws std::system_error naming the file that cannot be written, std::runtime_error when the
  ///   frame is of another camera than those before
  virtual void add(const RgbdFrame& frame) = 0;

  /// @param poses of the camera, where the recording has them; may be empty
  /// @throws as add()
  virtual void finish(const Trajectory& poses) = 0;
};

/// Whether images lose something: smaller files, or every bit.
struct WritingOptions {
  int jpeg_quality = 95;  ///< of colour in .klg files and logs, 1 to 100; 0: without loss
};

/// By the name: `.klg`, the log of Kintinuous and ElasticFusion; `.lcm`, a log of raw frames for
/// lcm-logplayer; else a folder in the layout of the TUM RGB-D benchmark.
/// @throws std::runtime_error when `path` exists, std::system_error when it cannot be written
std::unique_ptr<RecordingWriter> open_recording_writer(const std::filesystem::path& path,
                                                       const WritingOptions& options);

}  // namespace kintsugi::mapper
