// A mapper's log, read to resume its session.

#include <stdexcept>

#include "mapper/session/stored_sessions.hpp"
#include "tests/decoder_fuzz/log_events.hpp"
#include "tests/decoder_fuzz/require.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kintsugi;  // NOLINT(google-build-using-namespace)
  const auto events = fuzzing::read_events({data, size});
  mapper::StoredSessionReader reader;
  try {
    std::int64_t index = 0;
    for (const auto& event : events) {
      (void)reader.read({index, 1'000 * index, event.channel, event.data});
      ++index;
    }
  } catch (const std::runtime_error&) {
  }
  fuzzing::require(reader.sessions().size() <= events.size(), "a session begins with an event");
  return 0;
}
