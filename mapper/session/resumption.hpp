#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "mapper/session/mapping_options.hpp"
#include "mapper/session/session_store.hpp"
#include "mapper/source/frames/frame_source.hpp"

namespace kintsugi::mapper {

/// Decides whether a run is a new one, or continues the last one of its log, which was interrupted.
///
/// The log does not contain the state of the mapper. A resumed run maps the same frames again, from
/// the first one on, to restore it; slices that the log already contains are not sent
/// again.
class Resumption {
 public:
  struct Config {
    MappingOptions options;
    std::int64_t session = 0;  ///< 0: by the clock, or that of the log
    double max_range_m = 6.5;  ///< of stored frames that are mapped again
  };

  /// @param store must outlive this
  /// @throws std::runtime_error when the last run of the log was begun with other options or
  ///   another number; nothing is written then
  Resumption(SessionStore& store, const Config& config);

  /// The source for the run: it begins with the frames that were mapped already. A live camera
  /// cannot repeat them; unless the log contains them, a new run begins, with a warning.
  std::unique_ptr<FrameSource> attach(std::unique_ptr<FrameSource> source);

  std::int64_t session() const { return session_; }

  /// The last session of the log if its run is complete, so that there is nothing to map; else
  /// null.
  const StoredSession* ended_session() const;

  /// Time of the last frame that was mapped before the interruption; -1: none.
  std::int64_t last_mapped_utime() const { return last_mapped_utime_; }
  /// Time of the last raw frame in the log; -1: none.
  std::int64_t last_stored_utime() const { return continued_ ? continued_->last_frame_utime : -1; }
  /// Whether the frame of this time was mapped before the interruption.
  bool was_mapped(std::int64_t utime) const { return utime <= last_mapped_utime_; }
  /// Whether it was fused then, or only tracked; nullopt: it was not mapped.
  std::optional<bool> was_fused(std::int64_t utime) const;
  /// Whether a run whose last mapped frame has this time has repeated all frames that were mapped
  /// before the interruption.
  bool has_caught_up(std::int64_t last_utime) const;

 private:
  void begin_run(std::int64_t session);
  void continue_last_run();
  bool has_all_slices() const;
  std::unique_ptr<FrameSource> begin_anew(std::unique_ptr<FrameSource> source,
                                          const std::string& why);
  bool has_all_frames() const;
  std::unique_ptr<FrameSource> stored_frames_before(std::unique_ptr<FrameSource> camera) const;

  SessionStore& store_;
  const Config config_;
  std::int64_t session_ = 0;
  std::optional<StoredSession> continued_;  ///< none: a new run
  std::int64_t last_mapped_utime_ = -1;
};

}  // namespace kintsugi::mapper
