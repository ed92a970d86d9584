#pragma once
// Encoding and decoding of small messages, which are one LCM message each.

#include "lcmtypes/codec/wire.hpp"

namespace kintsugi::codec {

/// What the codec has to know of a small message:
///   WireType                 its LCM type
///   kNumStrings              number of its strings
///   kBytesPerCount           bytes of its arrays for each element that is counted; 0: no array
///   to_wire(), from_wire()   conversion between the struct and the LCM type
///   check(check, message)    throws when a field is out of its bounds
/// Most fields have the same name in the struct and in the LCM type, so that a template copy()
/// serves both directions.
template <class Message>
struct Small;

template <class Wire>
struct Shape {
  using WireType = Wire;
  static constexpr std::size_t kBytesPerCount = 0;
};

/// For messages whose struct and LCM type have the same fields: copy() is the whole conversion.
template <class Message, class Wire>
struct Copied : Shape<Wire> {
  static void to_wire(const Message& message, Wire& wire) { Small<Message>::copy(message, wire); }
  static void from_wire(const Wire& wire, Message& message) { Small<Message>::copy(wire, message); }
};

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
