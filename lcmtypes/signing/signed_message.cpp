#include "lcmtypes/signing/signed_message.hpp"

#include <algorithm>
#include <utility>

#include <sodium.h>

namespace kintsugi {
namespace signed_message {
namespace {

// Places in the signature.
constexpr std::size_t kSession = 0;
constexpr std::size_t kSequence = 8;
constexpr std::size_t kTag = 16;
constexpr std::size_t kMarkerPlace = kTag + BusKey::kTagBytes;
static_assert(kMarkerPlace + kMarker.size() == kSignatureBytes);

using Bytes8 = std::array<std::uint8_t, 8>;

Bytes8 little_endian(std::uint64_t value) {
  Bytes8 bytes{};
  for (std::uint8_t& byte : bytes) {
    byte = static_cast<std::uint8_t>(value);
    value >>= 8U;
  }
  return bytes;
}

std::uint64_t from_little_endian(ByteView bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = 8; i-- > 0;) value = value << 8U | bytes[i];
  return value;
}

}  // namespace

std::optional<Parts> split(ByteView data) {
  if (data.size() < kSignatureBytes) return std::nullopt;
  const ByteView signature = data.last(kSignatureBytes);
  if (!std::ranges::equal(signature.subspan(kMarkerPlace), kMarker)) return std::nullopt;
  Parts parts;
  parts.message = data.first(data.size() - kSignatureBytes);
  parts.session = from_little_endian(signature.subspan(kSession));
  parts.sequence = static_cast<std::int64_t>(from_little_endian(signature.subspan(kSequence)));
  std::ranges::copy(signature.subspan(kTag, BusKey::kTagBytes), parts.tag.begin());
  return parts;
}

BusKey::Tag tag(const BusKey& key, const std::string& channel, std::uint64_t session,
                std::int64_t sequence, ByteView message) {
  // c_str(): with the zero byte at its end.
  const ByteView channel_bytes(reinterpret_cast<const std::uint8_t*>(channel.c_str()),
                               channel.size() + 1);
  return key.tag({kMarker, little_endian(session),
                  little_endian(static_cast<std::uint64_t>(sequence)), channel_bytes, message});
}

bool is_genuine(const BusKey& key, const std::string& channel, const Parts& parts) {
  const BusKey::Tag right = tag(key, channel, parts.session, parts.sequence, parts.message);
  // In a time that does not tell how many bytes are right.
  return sodium_memcmp(right.data(), parts.tag.data(), right.size()) == 0;
}

Bytes sign(const BusKey& key, const std::string& channel, std::uint64_t session,
           std::int64_t sequence, ByteView message) {
  Bytes data;
  data.reserve(message.size() + kSignatureBytes);
  const auto append = [&data](const auto& bytes) {
    data.insert(data.end(), bytes.begin(), bytes.end());
  };
  append(message);
  append(little_endian(session));
  append(little_endian(static_cast<std::uint64_t>(sequence)));
  append(tag(key, channel, session, sequence, message));
  append(kMarker);
  return data;
}

std::uint64_t new_session() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const auto now_s = std::chrono::duration_cast<std::chrono::seconds>(now).count();
  return static_cast<std::uint64_t>(now_s) << 32U | randombytes_random();
}

std::uint32_t begin_s(std::uint64_t session) { return static_cast<std::uint32_t>(session >> 32U); }

}  // namespace signed_message

MessageSigner::MessageSigner(std::shared_ptr<const BusKey> key) : key_(std::move(key)) {}

Bytes MessageSigner::sign(const std::string& channel, ByteView message, Clock::time_point now) {
  std::uint64_t session = 0;
  std::int64_t sequence = 0;
  {
    const std::lock_guard lock(mutex_);
    if (sequence_ == 0 || now - last_ > kLongestSilence) {
      session_ = signed_message::new_session();
      sequence_ = 0;
    }
    last_ = std::max(last_, now);
    session = session_;
    sequence = ++sequence_;
  }
  return signed_message::sign(*key_, channel, session, sequence, message);
}

}  // namespace kintsugi
