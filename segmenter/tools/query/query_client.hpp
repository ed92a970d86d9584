#pragma once
// Sends queries to segmenters on the bus.

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/signing/process_key.hpp"
#include "lcmtypes/stream/stream_subscriber.hpp"

namespace kintsugi::segmenter {

/// One client of the segmenters on a bus. Belongs to one thread.
class QueryClient {
 public:
  using Seconds = std::chrono::duration<double>;

  /// Opens the bus; empty: the default one.
  /// @throws std::runtime_error when it cannot be opened
  explicit QueryClient(const std::string& lcm_url, std::shared_ptr<const BusKey> key = bus_key());

  /// Sends the query, and repeats it until an answer arrives, because queries and answers may be
  /// lost. Of several segmenters the first useful answer is returned; when there is none,
  /// SegmentAnswer::problem says why. Sets client, number and utime of the query.
  /// `meanwhile` is called every 0.1 s or more often while it waits; what it throws ends the wait.
  /// @throws std::runtime_error when nobody answers within `timeout`, with what was heard instead
  /// @throws std::invalid_argument for a query that is out of bounds, or a timeout that is negative
  SegmentAnswer ask(SegmentQuery query, Seconds timeout,
                    const std::function<void()>& meanwhile = {});

 private:
  using Clock = std::chrono::steady_clock;

  void take(SegmentAnswer answer);
  std::string silence(Seconds timeout, int times_asked) const;
  /// Handles messages until `is_done` or `deadline`; true when it is done.
  template <class IsDone>
  bool handle_until(Clock::time_point deadline, const std::function<void()>& meanwhile,
                    const IsDone& is_done);

  Bus bus_;
  const std::int64_t client_;
  std::int64_t number_ = 0;  // of the query that is being asked
  StreamSubscriber<SegmentAnswer> answers_;
  std::optional<SegmentAnswer> answer_;
  std::optional<SegmentAnswer> refusal_;
  std::optional<SegmenterStatus> status_;  // of any segmenter, the newest
};

}  // namespace kintsugi::segmenter
