// A mapper's log, read to resume its session and to be rewritten.

#include <stdexcept>

#include "mapper/session/log_contents.hpp"
#include "mapper/session/stored_sessions.hpp"
#include "tests/decoder_fuzz/log_events.hpp"
#include "tests/decoder_fuzz/require.hpp"

namespace {

/// Calls read(event, its index) for each event, until one is refused.
template <class Read>
void read_until_refused(const std::vector<kintsugi::fuzzing::LoggedMessage>& events,
                        const Read& read) {
  try {
    std::int64_t index = 0;
    for (const auto& event : events) {
      read(kintsugi::LogEvent{index, 1'000 * index, event.channel, event.data}, index);
      ++index;
    }
  } catch (const std::runtime_error&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kintsugi;  // NOLINT(google-build-using-namespace)
  const auto events = fuzzing::read_events({data, size});
  mapper::StoredSessionReader reader;
  read_until_refused(events,
                     [&](const LogEvent& event, std::int64_t) { (void)reader.read(event); });
  fuzzing::require(reader.sessions().size() <= events.size(), "a session begins with an event");
  mapper::LogContents contents;
  read_until_refused(events, [&](const LogEvent& event, std::int64_t index) {
    contents.read(event, {0, static_cast<std::int32_t>(event.data.size()), index});
  });
  fuzzing::require(contents.sessions().size() <= events.size(), "a session begins with an event");
  return 0;
}
