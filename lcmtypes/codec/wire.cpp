#include "lcmtypes/codec/wire.hpp"

#include <algorithm>
#include <limits>

namespace kintsugi::codec {
namespace {

std::int64_t big_endian(ByteView data, std::size_t place, std::size_t num_bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < num_bytes; ++i) value = value << 8U | data[place + i];
  return num_bytes == 4 ? static_cast<std::int32_t>(value) : static_cast<std::int64_t>(value);
}

/// Checks the string at `place`, and returns the place behind it.
std::size_t check_string(const Check& check, ByteView data, std::size_t place) {
  if (data.size() - place < 4) check.fail("size", data.size(), "room for a string's length");
  const std::int64_t length = big_endian(data, place, 4);  // with its terminator
  check.range<std::int64_t>("string length", length, 1, kMaxStringBytes + 1);
  place += 4;
  const auto end = place + static_cast<std::size_t>(length);
  if (end > data.size()) check.fail("string length", length, "no more than the message holds");
  const auto text = data.subspan(place, static_cast<std::size_t>(length));
  if (std::find(text.begin(), text.end(), 0) != text.end() - 1) {
    check.fail("string", "not terminated at its length", "one zero byte, at its end");
  }
  return end;
}

/// LCM computes the fingerprint from the fields of the type, so it differs for every version of an
/// .lcm file. It is compared first: a message of another version rarely has the right size.
void check_fingerprint(const WireShape& shape, ByteView data) {
  constexpr std::size_t kFingerprintBytes = 8;
  if (data.size() < kFingerprintBytes) return;  // check_size() refuses it
  if (big_endian(data, 0, kFingerprintBytes) == shape.fingerprint) return;
  throw std::invalid_argument(std::string(shape.type) +
                              ": the fingerprint is that of another type, or the message was sent "
                              "or recorded by another version of Kintsugi");
}

/// The size of the message, from its own lengths and counts.
void check_size(const Check& check, const WireShape& shape, ByteView data) {
  if (data.size() > std::numeric_limits<std::int32_t>::max()) {
    check.fail("size", data.size(), "less than 2 GiB");
  }
  if (data.size() < shape.fixed_bytes) {
    check.fail("size", data.size(), "at least " + std::to_string(shape.fixed_bytes) + " bytes");
  }
  std::size_t place = shape.fixed_bytes;
  for (int i = 0; i < shape.num_strings; ++i) place = check_string(check, data, place);

  const auto rest = static_cast<std::int64_t>(data.size() - place);
  if (shape.bytes_per_count == 0) {
    if (rest != 0) check.fail("size", data.size(), std::to_string(place) + " bytes");
    return;
  }
  const std::int64_t count = big_endian(data, shape.fixed_bytes - 4, 4);
  if (count < 0 || count * static_cast<std::int64_t>(shape.bytes_per_count) != rest) {
    check.fail(
        "array count", count,
        std::to_string(rest) + " bytes of " + std::to_string(shape.bytes_per_count) + " each");
  }
}

void check_checksum(const Check& check, const WireShape& shape, ByteView data) {
  const std::uint32_t claimed = claimed_checksum(data);
  if (claimed == 0 && shape.checksum_optional) return;
  const std::uint32_t computed = compute_checksum(data);
  if (claimed != computed) check.fail("checksum", claimed, std::to_string(computed));
}

}  // namespace

void check_wire(const WireShape& shape, ByteView data) {
  const Check check(shape.type);
  check_fingerprint(shape, data);
  check_size(check, shape, data);
  check_checksum(check, shape, data);
}

}  // namespace kintsugi::codec
