#pragma once
// A message of the bus, or of a log of it, with its signature.
//
// The signature stands behind the message, so that programs of LCM that know no signatures
// (lcm-spy, lcm-logger, lcm-logplayer) find the fields where they always are. It has 40 bytes: the
// session of the sender (8), the sequence number (8), the tag (16), the marker (8); numbers are
// little-endian.

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "lcmtypes/codec/codec.hpp"
#include "lcmtypes/signing/bus_key.hpp"

namespace kintsugi::signed_message {

/// Ends every signed message: tells "not signed" from "signed with another key". The last byte is
/// the version of the signature.
inline constexpr std::array<std::uint8_t, 8> kMarker = {'K', 'I', 'N', 'T', 'S', 'I', 'G', '1'};
inline constexpr std::size_t kSignatureBytes = 40;

/// The tag of a message: of the marker, the session, the sequence number, the channel, a zero byte,
/// the message.
BusKey::Tag tag(const BusKey& key, const std::string& channel, std::uint64_t session,
                std::int64_t sequence, ByteView message);

/// A message that ends with a signature, right or wrong.
struct Parts {
  ByteView message;  ///< without the signature
  std::uint64_t session = 0;
  std::int64_t sequence = 0;
  BusKey::Tag tag{};
};

/// Nothing: the message has no signature.
std::optional<Parts> split(ByteView data);

/// True when the tag of the message is the one that `key` gives.
bool is_genuine(const BusKey& key, const std::string& channel, const Parts& parts);

/// The message with its signature.
Bytes sign(const BusKey& key, const std::string& channel, std::uint64_t session,
           std::int64_t sequence, ByteView message);

/// A number for a sender that begins now: seconds since 1970 in the upper 32 bits, random below.
std::uint64_t new_session();
/// When the session began, seconds since 1970.
std::uint32_t begin_s(std::uint64_t session);

}  // namespace kintsugi::signed_message

namespace kintsugi {

/// Signs the messages of one sender. Threads may share it.
class MessageSigner {
 public:
  using Clock = std::chrono::steady_clock;
  /// A sender that was silent for longer begins a new session: receivers may have forgotten the
  /// old one (SeenMessages).
  static constexpr std::chrono::minutes kLongestSilence{10};

  /// `key` is not null.
  explicit MessageSigner(std::shared_ptr<const BusKey> key);

  /// The message with a signature, whose number no other message has.
  Bytes sign(const std::string& channel, ByteView message, Clock::time_point now = Clock::now());

 private:
  const std::shared_ptr<const BusKey> key_;
  std::mutex mutex_;  // guards what follows
  std::uint64_t session_ = 0;
  std::int64_t sequence_ = 0;  // of the last message
  Clock::time_point last_;
};

}  // namespace kintsugi
