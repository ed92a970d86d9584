#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/stream/stream_subscriber.hpp"
#include "viewer/receiving/map_choice.hpp"
#include "viewer/receiving/message.hpp"

namespace kintsugi::viewer {

/// Receives the messages of one map from the bus or a log: joins chunks to complete, checked
/// messages and requests slices and updates that are missing. Bad messages are counted and
/// reported.
class Receiver {
 public:
  struct Config {
    std::string map_name;                   ///< use only this map; empty: the first one received
    std::int64_t receiver = 0;              ///< number of this process, sent with its requests
    std::size_t max_request_bytes = 1'400;  ///< size of a request, at most what the bus transports
    std::function<bool()> has_room;         ///< for slices and updates; empty: always
    /// Memory for incomplete messages of each stream that is sent again, bytes; a single larger
    /// message is accepted.
    std::size_t max_pending_bytes = std::size_t{1} << 28U;
  };
  using OnMessage = std::function<void(Message)>;
  /// `count`: number of bad messages so far
  using OnBad = std::function<void(std::int64_t count, const std::string& reason)>;

  Receiver(const Config& config, OnMessage on_message, OnBad on_bad);

  /// bus.handle() calls this object from now on, so the object must outlive the calls.
  void subscribe(Bus& bus);

  /// Requests missing slices and updates, when requests are due; call it often, on the thread of
  /// bus.handle(). `now_s` is the time of a PatientClock.
  void request_missing(Bus& bus, double now_s);

  /// Handles one recorded message.
  void handle(const std::string& channel, ByteView data);

  // The following are thread-safe.

  /// Ignores this map session from now on.
  void forget(std::int64_t map_session) { slices_.forget(map_session); }

  /// Slices or updates are missing and are still being requested.
  bool may_still_come() const;

  /// Adds the receiver's counts, and its problem when `status` has none.
  void add_to(ViewerStatus& status) const;

 private:
  template <class Bulk>
  StreamSubscriberConfig<Bulk> stream_config(const Config& config) const;
  void use(SegmentUpdate update);
  template <SmallMessage Small>
  void handle_small(ByteView data);
  void bad(const DecodeError& reason);

  OnMessage on_message_;
  OnBad on_bad_;
  MapChoice choice_;
  std::int64_t segmenter_session_ = 0;  // the newest one received
  std::atomic<std::int64_t> bad_{0};
  StreamSubscriber<CloudSlice> slices_;
  StreamSubscriber<SegmentUpdate> updates_;
  StreamSubscriber<CameraView> views_;       // never requested again
  StreamSubscriber<SegmentAnswer> answers_;  // to queries of any client; never requested again
};

}  // namespace kintsugi::viewer
