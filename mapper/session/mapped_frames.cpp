#include "mapper/session/mapped_frames.hpp"

#include <limits>
#include <stdexcept>

namespace kintsugi::mapper {
namespace {

/// Seven bits a byte, the lowest first; the last byte is below 128.
void put(Bytes& bytes, std::uint64_t number) {
  for (; number >= 128; number >>= 7U) bytes.push_back(static_cast<std::uint8_t>(number | 128U));
  bytes.push_back(static_cast<std::uint8_t>(number));
}

std::int64_t take(ByteView& data) {
  std::uint64_t number = 0;
  for (unsigned shift = 0; !data.empty() && shift < 63; shift += 7) {
    const std::uint8_t byte = data.front();
    data = data.subspan(1);
    number |= std::uint64_t{byte & 127U} << shift;
    if (byte < 128) return static_cast<std::int64_t>(number);
  }
  throw std::runtime_error("its list of mapped frames cannot be read");
}

void add_later(std::int64_t utime, std::vector<std::int64_t>& to) {
  if (to.empty() || utime > to.back()) to.push_back(utime);
}

}  // namespace

Bytes encode_mapped_frames(std::int64_t session, std::span<const std::int64_t> utimes) {
  Bytes bytes;
  put(bytes, static_cast<std::uint64_t>(session));
  std::int64_t last = 0;
  for (const std::int64_t utime : utimes) {
    put(bytes, static_cast<std::uint64_t>(utime - last));
    last = utime;
  }
  return bytes;
}

MappedFrames decode_mapped_frames(ByteView data) {
  MappedFrames frames{.session = take(data), .utimes = {}};
  std::int64_t last = 0;
  while (!data.empty()) {
    const std::int64_t step = take(data);
    if (step > std::numeric_limits<std::int64_t>::max() - last) {
      throw std::runtime_error("its list of mapped frames cannot be read");
    }
    last += step;
    frames.utimes.push_back(last);
  }
  return frames;
}

void FrameHistory::add(std::int64_t utime) { add_later(utime, mapped_utimes); }

void FrameHistory::add(const std::string& channel, const MappedFrames& frames) {
  for (const std::int64_t utime : frames.utimes) {
    add_later(utime, mapped_utimes);
    if (channel == kTrackedOnlyChannel) add_later(utime, tracked_only_utimes);
  }
}

}  // namespace kintsugi::mapper
