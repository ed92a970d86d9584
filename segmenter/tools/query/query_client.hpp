#pragma once
// Asks a segmenter on the bus, and hears where the camera is.

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/stream/stream_subscriber.hpp"

namespace kintsugi::segmenter {

/// Where a camera is, and how it sees.
struct CameraView {
  CameraPose pose;
  std::optional<Intrinsics> intrinsics;  ///< nothing: no raw frame was heard
};

/// One client of the segmenters on a bus. Belongs to one thread.
class QueryClient {
 public:
  using Seconds = std::chrono::duration<double>;

  /// Opens the bus; empty: the default one. Throws std::runtime_error when it cannot be opened.
  explicit QueryClient(const std::string& lcm_url);

  /// Asks, and asks again as long as no answer comes: queries and answers may be lost. Of several
  /// segmenters the first that has an answer gives it; where none has, SegmentAnswer::problem says
  /// why. Throws std::runtime_error saying what was heard when nobody answers in `timeout`, and
  /// std::invalid_argument for a query that is out of bounds; its client, number and utime are set
  /// here.
  SegmentAnswer ask(SegmentQuery query, Seconds timeout);

  /// The newest pose of a camera that knows where it is, of the mapper session `map_session` (0:
  /// any). Intrinsics come along when raw frames are heard within a moment. Throws
  /// std::runtime_error saying what was heard when no such pose comes in `timeout`. Call it once.
  CameraView hear_camera(std::int64_t map_session, Seconds timeout);

 private:
  using Clock = std::chrono::steady_clock;

  void take(SegmentAnswer answer);
  std::string silence(Seconds timeout, int times_asked) const;
  /// Handles messages until `is_done` or `deadline`; true when it is done.
  template <class IsDone>
  bool handle_until(Clock::time_point deadline, const IsDone& is_done);

  Bus bus_;
  const std::int64_t client_;
  std::int64_t number_ = 0;  // of the query that is being asked
  StreamSubscriber<SegmentAnswer> answers_;
  std::optional<SegmentAnswer> answer_;
  std::optional<SegmentAnswer> refusal_;
  std::optional<SegmenterStatus> status_;  // of any segmenter, the newest
  std::optional<CameraPose> pose_;         // the newest of a camera that knows where it is
  bool camera_is_lost_ = false;
  std::optional<Intrinsics> intrinsics_;
};

}  // namespace kintsugi::segmenter
