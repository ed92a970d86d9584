#pragma once
// Raw datagrams of a multicast group, as LCM sends them.

#include <cstdint>
#include <optional>
#include <string>

#include <netinet/in.h>

#include "lcmtypes/codec/codec.hpp"

namespace kintsugi::testing {

/// A socket in a multicast group: reaches this host and, with a time to live, the local network.
/// It does not receive what it sent itself. For use by one thread.
class MulticastPort {
 public:
  /// `url` as LCM has it, udpm://GROUP:PORT?ttl=N. Throws std::invalid_argument for another,
  /// std::system_error when the port cannot be opened.
  explicit MulticastPort(const std::string& url);
  ~MulticastPort();
  MulticastPort(const MulticastPort&) = delete;
  MulticastPort& operator=(const MulticastPort&) = delete;

  /// For poll(): readable when receive() may give something.
  int descriptor() const { return receiver_; }

  /// The next datagram of another sender; nothing when none is waiting.
  std::optional<Bytes> receive();
  /// Throws std::system_error.
  void send(ByteView datagram);

  /// Datagrams that were lost because the receive buffer was full.
  std::int64_t lost() const { return lost_; }

 private:
  Bytes buffer_;  // holds the largest datagram
  int receiver_ = -1;
  int sender_ = -1;
  sockaddr_in own_{};  // the source address of what it sends
  std::int64_t lost_ = 0;
};

}  // namespace kintsugi::testing
