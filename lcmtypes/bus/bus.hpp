#pragma once
// One LCM instance: opened with a clear error, callbacks that may throw.

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/codec/codec.hpp"

struct _lcm_t;  // LCM's own name NOLINT(bugprone-reserved-identifier)

namespace kintsugi {

/// Wall clock, microseconds since 1970.
std::int64_t wall_clock_us();

/// A session number for a run that starts now: the wall clock, so that later runs have larger ones.
std::int64_t new_session();

/// The URL that `Bus("")` opens: LCM_DEFAULT_URL, or LCM's own multicast group on this host.
std::string default_bus_url();

/// Text with the one command that cures it when the kernel's limit for receive buffers is smaller
/// than what a Bus asks for; nothing when it is large enough.
std::optional<std::string> receive_buffer_advice();

/// One connection to the bus. Publishing is thread safe; handle() belongs to one thread.
class Bus {
 public:
  using Handler = std::function<void(ByteView message)>;

  /// `url` as LCM has it; empty: default_bus_url(). A receive buffer size is asked for where the
  /// URL names none. Throws std::runtime_error with the cure when there is no multicast route, or
  /// when LCM cannot open the URL.
  explicit Bus(const std::string& url = "");
  ~Bus();
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  /// Sends one LCM message. What the network does not take at the moment is lost, as what it drops
  /// on the way, and counted: streams send it again. Throws std::runtime_error when it cannot be
  /// sent for another reason.
  void publish(const std::string& channel, ByteView message);

  template <SmallMessage Message>
  void publish(const std::string& channel, const Message& message) {
    publish(channel, ByteView(encode(message)));
  }

  /// Calls `handler` in handle() for each message on `channel`; nothing is dropped from the queue.
  /// Call before the first handle(), or from its thread.
  void subscribe(const std::string& channel, Handler handler);

  /// Waits for a message and hands it on; false when none came in `timeout`. What a handler threw
  /// is thrown here. Throws std::runtime_error when the connection is gone.
  bool handle(std::chrono::milliseconds timeout);

  const std::string& url() const { return url_; }
  std::int64_t messages_refused() const { return messages_refused_; }  ///< by the network

  /// The largest message that arrives well: one datagram where the bus stays on this host (or is a
  /// file), one Ethernet frame where it leaves it (ttl > 0). What a StreamPublisher takes as
  /// max_chunk_bytes. Bytes.
  std::size_t max_message_bytes() const;

 private:
  struct Subscriber;

  std::string url_;
  std::unique_ptr<_lcm_t, void (*)(_lcm_t*)> lcm_;
  std::vector<std::unique_ptr<Subscriber>> subscribers_;
  std::exception_ptr failure_;
  std::atomic<std::int64_t> messages_refused_{0};
};

}  // namespace kintsugi
