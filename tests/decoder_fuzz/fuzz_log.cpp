// An LCM log: every event that is read lies within the file.

#include <stdexcept>

#include "lcmtypes/log/log_reader.hpp"
#include "tests/decoder_fuzz/input_file.hpp"
#include "tests/decoder_fuzz/require.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using kintsugi::fuzzing::require;
  const auto path = kintsugi::fuzzing::write_input("log", {data, size});
  try {
    kintsugi::LogReader log(path);
    std::size_t bytes = 0;
    while (const auto event = log.next()) bytes += event->channel.size() + event->data.size();
    require(bytes < size, "events are no larger than the log");
    require(log.damage().has_value() != (log.bytes_read() == static_cast<std::int64_t>(size)),
            "what is not read is damaged");
  } catch (const std::runtime_error&) {
  }
  return 0;
}
