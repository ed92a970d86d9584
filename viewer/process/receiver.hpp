#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <variant>

#include "lcmtypes/bus.hpp"
#include "lcmtypes/stream_subscriber.hpp"

namespace kintsugi::viewer {

/// What the viewer takes from the bus or a log.
using Message = std::variant<CloudSlice, SegmentUpdate, CameraPose, SegmenterStatus>;

/// Turns what arrives into whole, checked messages. What cannot be used is counted and reported
/// with the count so far.
class Receiver {
 public:
  using OnMessage = std::function<void(Message)>;
  using OnBad = std::function<void(std::int64_t count, const std::string& reason)>;

  Receiver(const OnMessage& on_message, OnBad on_bad);

  /// From now on bus.handle() calls back; this must outlive that.
  void subscribe(Bus& bus);

  /// One recorded message.
  void handle(const std::string& channel, ByteView data);

  std::int64_t chunks_missing() const;  ///< of slices and updates, now
  std::int64_t messages_bad() const;    ///< of every kind, since the start

 private:
  template <SmallMessage Small>
  void handle_small(ByteView data);
  void bad(const DecodeError& reason);

  OnMessage on_message_;
  OnBad on_bad_;
  std::atomic<std::int64_t> bad_{0};
  StreamSubscriber<CloudSlice> slices_;
  StreamSubscriber<SegmentUpdate> updates_;
};

}  // namespace kintsugi::viewer
