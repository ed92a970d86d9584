#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/stream/stream_subscriber.hpp"
#include "viewer/process/map_choice.hpp"
#include "viewer/process/message.hpp"

namespace kintsugi::viewer {

/// Turns what arrives of one map into whole, checked messages, and asks for slices and updates that
/// are missing. What cannot be used is counted and reported with the count so far.
class Receiver {
 public:
  struct Config {
    std::string map_name;                   ///< take only this map; empty: the first that is heard
    std::int64_t receiver = 0;              ///< number of this process, said in its requests
    std::size_t max_request_bytes = 1'400;  ///< of one request: what the bus takes
    std::function<bool()> has_room;         ///< for slices and updates; empty: always
    /// Of incomplete messages on each stream, bytes; a larger message is taken alone.
    std::size_t max_pending_bytes = std::size_t{1} << 28U;
  };
  using OnMessage = std::function<void(Message)>;
  using OnBad = std::function<void(std::int64_t count, const std::string& reason)>;

  Receiver(const Config& config, OnMessage on_message, OnBad on_bad);

  /// From now on bus.handle() calls back; this must outlive that.
  void subscribe(Bus& bus);

  /// Asks for what is missing; for the tick of a BusThread. `now_s` is a PatientClock's.
  void ask(Bus& bus, double now_s);

  /// One recorded message.
  void handle(const std::string& channel, ByteView data);

  /// Nothing more is wanted of this map session. Any thread may call it, and what follows.
  void forget(std::int64_t map_session) { slices_.forget(map_session); }

  /// Something is missing that has not been given up.
  bool may_still_come() const;

  /// What it knows of `status`.
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
  std::int64_t segmenter_session_ = 0;  // the newest
  std::atomic<std::int64_t> bad_{0};
  StreamSubscriber<CloudSlice> slices_;
  StreamSubscriber<SegmentUpdate> updates_;
  StreamSubscriber<SegmentAnswer> answers_;  // to whoever asked; one that is lost stays lost
};

}  // namespace kintsugi::viewer
