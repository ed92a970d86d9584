#pragma once
// Sends queries to segmenters on the bus, and listens to the camera pose.

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/stream/stream_subscriber.hpp"

namespace kintsugi::segmenter {

/// The pose of a camera and, if known, its intrinsics.
struct HeardCamera {
  CameraPose pose;
  std::optional<Intrinsics> intrinsics;  ///< absent: no raw frame was received
};

/// One client of the segmenters on a bus. Belongs to one thread.
class QueryClient {
 public:
  using Seconds = std::chrono::duration<double>;

  /// Opens the bus; empty: the default one.
  /// @throws std::runtime_error when it cannot be opened
  explicit QueryClient(const std::string& lcm_url);

  /// Sends the query, and repeats it until an answer arrives, because queries and answers may be
  /// lost. Of several segmenters the first useful answer is returned; when there is none,
  /// SegmentAnswer::problem says why. Sets client, number and utime of the query.
  /// @throws std::runtime_error when nobody answers within `timeout`, with what was heard instead
  /// @throws std::invalid_argument for a query that is out of bounds
  SegmentAnswer ask(SegmentQuery query, Seconds timeout);

  /// The newest tracked pose of a camera, of the mapper session `map_session` (0: any), with the
  /// intrinsics if raw frames arrive within half a second. Call it once.
  /// @throws std::runtime_error when no such pose arrives within `timeout`, with what was heard
  HeardCamera hear_camera(std::int64_t map_session, Seconds timeout);

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
  std::optional<CameraPose> pose_;         // the newest tracked one
  bool camera_is_lost_ = false;
  std::optional<Intrinsics> intrinsics_;
};

}  // namespace kintsugi::segmenter
