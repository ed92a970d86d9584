#pragma once
// A connection to the bus, which is LCM: with clear errors, handlers that may throw, and signed
// messages where there is a key.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/codec/codec.hpp"
#include "lcmtypes/signing/message_guard.hpp"

struct _lcm_t;  // declared by LCM NOLINT(bugprone-reserved-identifier)

namespace kintsugi {

/// Wall clock, microseconds since 1970.
std::int64_t wall_clock_us();

/// A session number for a run that starts now. It is the wall clock, so that a later run has a
/// larger number.
std::int64_t new_session();

/// The URL that Bus("") opens: LCM_DEFAULT_URL, or LCM's default multicast group on this host.
std::string default_bus_url();

/// @throws std::runtime_error when LCM has no transport of the name with which `url` begins; empty:
///   default_bus_url()
void check_bus_url(const std::string& url);

/// When the kernel's limit of receive buffers is below what Bus asks for: a text for a person, with
/// the command that raises it. Nothing when the limit is high enough.
std::optional<std::string> receive_buffer_advice();

/// One connection to the bus. Publishing is thread safe; handle() belongs to one thread.
class Bus {
 public:
  using Handler = std::function<void(ByteView message)>;

  /// With the key of this process (bus_key()), and where the URL is that of a log, log_trust().
  /// @throws std::runtime_error as below, and when the key cannot be read
  explicit Bus(const std::string& url = "");
  /// @param url an LCM URL; empty: default_bus_url(). If it gives no receive buffer size, one is
  /// added
  /// @param trust with a key every message is signed, and only messages that are signed with it are
  ///   received, once each; without one messages are sent and received as they are
  /// @throws std::runtime_error when there is no multicast route, with the command that adds one,
  ///   or when LCM cannot open the URL
  Bus(const std::string& url, const MessageTrust& trust);
  ~Bus();
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  /// Sends one LCM message. A message that the network refuses at the moment (an interface is down,
  /// a queue is full) is lost like one that is dropped on its way: streams resend it.
  /// @throws std::runtime_error when it cannot be sent for another reason
  void publish(const std::string& channel, ByteView message);

  template <SmallMessage Message>
  void publish(const std::string& channel, const Message& message) {
    publish(channel, ByteView(encode(message)));
  }

  /// From now on handle() calls `handler` with each message on `channel`. The queue of received
  /// messages has no limit. Call it before the first handle(), or in the same thread.
  void subscribe(const std::string& channel, Handler handler);

  /// Waits for a message and calls its handler. Returns false when none is received in `timeout`.
  /// @throws std::runtime_error when the connection is lost or a log is signed and there is no key,
  ///   and whatever the handler throws
  bool handle(std::chrono::milliseconds timeout);

  const std::string& url() const { return url_; }

  /// What this connection has refused. In the thread of handle().
  const RefusedMessages& refused() const { return guard_.refused(); }

  /// The largest message that is rarely lost: one datagram if the bus stays on this host or is a
  /// file, one Ethernet frame if it leaves the host (ttl > 0). For max_chunk_bytes of a
  /// StreamPublisher. Signed or not: there is room for a signature besides.
  std::size_t max_message_bytes() const;

 private:
  struct Channel;

  void check_descriptor() const;
  void keep_failure();

  std::string url_;
  std::optional<MessageSigner> signer_;  // with a key
  MessageGuard guard_;
  std::unique_ptr<_lcm_t, void (*)(_lcm_t*)> lcm_;
  std::map<std::string, std::unique_ptr<Channel>> channels_;  // that are subscribed to
  std::exception_ptr failure_;
};

}  // namespace kintsugi
