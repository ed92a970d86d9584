#include "lcmtypes/codec/wire.hpp"

#include <algorithm>
#include <limits>

namespace kintsugi::codec {
namespace {

std::int64_t big_endian(ByteView data, std::size_t place, int num_bytes) {
  std::uint64_t value = 0;
  for (int i = 0; i < num_bytes; ++i) value = value << 8U | data[place + i];
  return num_bytes == 4 ? static_cast<std::int32_t>(value) : static_cast<std::int64_t>(value);
}

/// The place behind the string at `place`.
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

/// Fingerprint, lengths and counts against the size of the message.
void check_size(const Check& check, const WireShape& shape, ByteView data) {
  if (data.size() > std::numeric_limits<std::int32_t>::max()) {
    check.fail("size", data.size(), "less than 2 GiB");
  }
  if (data.size() < shape.fixed_bytes) {
    check.fail("size", data.size(), "at least " + std::to_string(shape.fixed_bytes) + " bytes");
  }
  const std::int64_t fingerprint = big_endian(data, 0, 8);
  if (fingerprint != shape.fingerprint) {
    check.fail("fingerprint", fingerprint, std::to_string(shape.fingerprint));
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
  check_size(check, shape, data);
  check_checksum(check, shape, data);
}

}  // namespace kintsugi::codec
