#include "tests/decoder_fuzz/log_events.hpp"

#include <cstdint>

namespace kintsugi::fuzzing {
namespace {

constexpr std::uint32_t kSyncWord = 0xEDA1DA01;
constexpr std::size_t kHeaderBytes = 28;

void append(Bytes& log, std::uint64_t value, int num_bytes) {
  for (int i = num_bytes - 1; i >= 0; --i) {
    log.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
  }
}

std::uint32_t word(ByteView log, std::size_t place) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8U | log[place + i];
  return value;
}

}  // namespace

std::vector<LoggedMessage> read_events(ByteView log) {
  std::vector<LoggedMessage> events;
  while (log.size() >= kHeaderBytes && word(log, 0) == kSyncWord) {
    const std::uint64_t channel_bytes = word(log, 20);
    const std::uint64_t data_bytes = word(log, 24);
    log = log.subspan(kHeaderBytes);
    if (channel_bytes + data_bytes > log.size()) break;
    const ByteView channel = log.first(channel_bytes);
    const ByteView data = log.subspan(channel_bytes, data_bytes);
    events.push_back({{channel.begin(), channel.end()}, {data.begin(), data.end()}});
    log = log.subspan(channel_bytes + data_bytes);
  }
  return events;
}

Bytes write_events(const std::vector<LoggedMessage>& events) {
  Bytes log;
  std::uint64_t number = 0;
  for (const LoggedMessage& event : events) {
    append(log, kSyncWord, 4);
    append(log, number, 8);
    append(log, 1'700'000'000'000'000 + 1'000 * number++, 8);
    append(log, event.channel.size(), 4);
    append(log, event.data.size(), 4);
    log.insert(log.end(), event.channel.begin(), event.channel.end());
    log.insert(log.end(), event.data.begin(), event.data.end());
  }
  return log;
}

}  // namespace kintsugi::fuzzing
