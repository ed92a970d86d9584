#pragma once
// Messages that are one LCM message each: what all of them have in common.

#include "lcmtypes/codec/wire.hpp"

namespace kintsugi::codec {

/// What the codec knows of a small message: its LCM type, its shape, to_wire(), from_wire() and
/// check(). Field names are the same in struct and LCM type, so one copy() serves both directions.
template <class Message>
struct Small;

template <class Wire>
struct Shape {
  using WireType = Wire;
  static constexpr std::size_t kBytesPerCount = 0;
};

/// The messages whose struct and LCM type differ in nothing.
template <class Message, class Wire>
struct Copied : Shape<Wire> {
  static void to_wire(const Message& message, Wire& wire) { Small<Message>::copy(message, wire); }
  static void from_wire(const Wire& wire, Message& message) { Small<Message>::copy(wire, message); }
};

inline void check_state(const Check& check, TrackingState state) {
  check.range("state", static_cast<int>(state), 0, static_cast<int>(TrackingState::kGiven));
}

}  // namespace kintsugi::codec

namespace kintsugi {

template <SmallMessage Message>
Bytes encode(const Message& message) {
  using Traits = codec::Small<Message>;
  using Wire = typename Traits::WireType;
  Traits::check(codec::Check(Wire::getTypeName()), message);
  Wire wire{};
  Traits::to_wire(message, wire);
  return codec::encode_wire(wire);
}

template <SmallMessage Message>
Message decode(ByteView data) {
  using Traits = codec::Small<Message>;
  using Wire = typename Traits::WireType;
  return codec::as_decode_error([&] {
    const Wire wire = codec::decode_wire<Wire>(data, Traits::kNumStrings, Traits::kBytesPerCount);
    Message message;
    Traits::from_wire(wire, message);
    Traits::check(codec::Check(Wire::getTypeName()), message);
    return message;
  });
}

}  // namespace kintsugi
