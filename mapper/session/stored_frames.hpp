#pragma once
// Raw frames in a SessionStore. Without them the session of a live camera cannot be resumed.

#include <cstdint>
#include <memory>
#include <optional>

#include "mapper/core/frame/rgbd_frame.hpp"
#include "mapper/session/stored_stream.hpp"
#include "mapper/source/bus/rgbd_frame_decoder.hpp"
#include "mapper/source/frames/frame_source.hpp"

namespace kintsugi::mapper {

/// Stores frames in the log, without loss, before they are mapped, so every mapped frame is there.
class FrameStore {
 public:
  /// @param stored_until_utime frames up to this time are stored already; -1: none is
  FrameStore(StoredStream& stream, std::int64_t session, std::int64_t stored_until_utime);

  void add(const RgbdFrame& frame);

 private:
  StoredStream& stream_;
  const std::int64_t session_;
  const std::int64_t stored_until_utime_;
};

/// Returns the frames in the log, then those of the camera, with continuous times and numbers.
class StoredThenLiveSource : public FrameSource {
 public:
  /// @param chunks_end one past the last chunk of the last complete frame
  /// @param pause_us between the last stored frame and the first of the camera
  /// @param ends_there mapping had ended when the session was interrupted: the camera is not read
  StoredThenLiveSource(const StoredStream& stored, std::int64_t chunks_end, double max_range_m,
                       std::unique_ptr<FrameSource> camera, std::int64_t pause_us, bool ends_there);

  /// @throws std::runtime_error when a stored frame cannot be read
  std::optional<RgbdFrame> next() override;
  [[nodiscard]] SourceStatus status() const override;

 private:
  RgbdFrame read_stored();

  const StoredStream& stored_;
  const std::int64_t chunks_end_;
  RgbdFrameDecoder decoder_;
  std::unique_ptr<FrameSource> camera_;
  const std::int64_t pause_us_;
  const bool ends_there_;
  std::int64_t next_chunk_ = 0;
  std::int64_t num_stored_ = 0;  ///< given
  std::int64_t last_utime_ = 0;
  std::int64_t last_index_ = -1;
  std::optional<std::int64_t> utime_shift_;  ///< of the camera's frames, once there is one
  std::int64_t index_shift_ = 0;
};

}  // namespace kintsugi::mapper
