#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "mapper/process/options.hpp"
#include "mapper/session/session_log.hpp"
#include "mapper/source/frame_source.hpp"

namespace kintsugi::mapper {

/// Which session a run maps: a new one, or the last one of its log from where it was interrupted.
///
/// The state of mapping is not in the log. It is made again by mapping the same frames again;
/// slices that the log has are not sent again.
class Resumption {
 public:
  /// @throws std::runtime_error when the last session of the log cannot go on with these options;
  ///   nothing is written then
  Resumption(SessionLog& log, const Options& options);

  /// The source for the session: one that begins with the frames which the session had mapped. A
  /// live camera cannot give them again; unless the log has them, a new session begins, which is
  /// said.
  std::unique_ptr<FrameSource> attach(std::unique_ptr<FrameSource> source);

  std::int64_t session() const { return session_; }
  /// The last session of the log, when all of it has been published.
  const StoredSession* ended_session() const;

  /// Of the frames that were mapped before the session was interrupted; -1: none.
  std::int64_t last_mapped_utime() const { return last_mapped_utime_; }
  /// Of the raw frames in the log; -1: none.
  std::int64_t last_stored_utime() const { return continued_ ? continued_->last_frame_utime : -1; }
  /// This frame was mapped before the session was interrupted.
  bool was_mapped(std::int64_t utime) const { return utime <= last_mapped_utime_; }
  /// Everything has been made again that was there, when the last mapped frame is this one.
  bool has_caught_up(std::int64_t last_utime) const;

 private:
  void begin_new_session();
  bool has_all_frames() const;
  std::unique_ptr<FrameSource> stored_frames_before(std::unique_ptr<FrameSource> camera) const;

  SessionLog& log_;
  const double max_range_m_;
  const MappingOptions options_;
  std::int64_t wanted_session_;
  std::int64_t session_ = 0;
  std::optional<StoredSession> continued_;
  std::int64_t last_mapped_utime_ = -1;
};

}  // namespace kintsugi::mapper
