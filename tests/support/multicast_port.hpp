#pragma once
// Raw datagrams of a multicast group, as LCM sends them.

#include <cstdint>
#include <optional>
#include <string>

#include <netinet/in.h>

#include "lcmtypes/codec/codec.hpp"

namespace kintsugi::testing {

/// A group and port that others on this host and, with a time to live, on the link listen to.
/// What it sent itself it does not hear. One thread.
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

  /// The next datagram of another sender; nothing when none waits.
  std::optional<Bytes> receive();
  /// Throws std::system_error.
  void send(ByteView datagram);

  /// Datagrams that came and found the receive buffer full.
  std::int64_t lost() const { return lost_; }

 private:
  Bytes buffer_;  // holds the largest datagram
  int receiver_ = -1;
  int sender_ = -1;
  sockaddr_in own_{};  // where what it sends comes from
  std::int64_t lost_ = 0;
};

}  // namespace kintsugi::testing
