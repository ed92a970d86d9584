// A log of messages: one of them changed, with the right checksum; or one lost, repeated or moved.

#include <random>

#include "lcmtypes/codec/checksum.hpp"
#include "tests/decoder_fuzz/log_events.hpp"
#include "tests/decoder_fuzz/mutator.hpp"

namespace {

using kintsugi::Bytes;
using kintsugi::fuzzing::LoggedMessage;

void mutate(LoggedMessage& event, std::size_t max_growth) {
  event.data = kintsugi::fuzzing::mutated(event.data, event.data.size() + max_growth);
  if (event.data.size() >= kintsugi::codec::kChecksumEnd) {
    kintsugi::codec::set_checksum(event.data);
  }
}

void change_one(std::vector<LoggedMessage>& events, std::size_t max_growth,
                std::minstd_rand& random) {
  const std::size_t i = random() % events.size();
  const std::size_t other = random() % events.size();
  const auto place = events.begin() + static_cast<std::ptrdiff_t>(i);
  switch (random() % 8) {
    case 0:
      events.erase(place);
      break;
    case 1:
      events.insert(place, LoggedMessage(events[other]));
      break;
    case 2:
      std::swap(events[i], events[other]);
      break;
    default:
      mutate(events[i], max_growth);
  }
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  std::minstd_rand random(seed);
  std::vector<LoggedMessage> events = kintsugi::fuzzing::read_events({data, size});
  // Now and then, and where there is no event, bytes of the log itself.
  if (events.empty() || random() % 16 == 0) return LLVMFuzzerMutate(data, size, max_size);
  constexpr std::size_t kMaxGrowth = 512;
  change_one(events, std::min(kMaxGrowth, max_size - size), random);
  Bytes log = kintsugi::fuzzing::write_events(events);
  log.resize(std::min(log.size(), max_size));
  std::copy(log.begin(), log.end(), data);
  return log.size();
}
