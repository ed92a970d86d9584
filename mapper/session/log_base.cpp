#include "mapper/session/log_base.hpp"

#include <charconv>
#include <stdexcept>
#include <string>
#include <system_error>

#include "lcmtypes/log/log_reader.hpp"

namespace kintsugi::mapper {

Bytes base_before(std::int32_t next_number) {
  const std::string text = std::to_string(next_number) + '\n';
  return {text.begin(), text.end()};
}

std::int32_t next_after_base(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::file_size(path, ignored) == 0) return 1;  // killed before the first event
  LogReader reader(path, MessageTrust{});
  const auto event = reader.next();
  if (!event || event->channel != kBaseChannel) return 1;
  const std::string text(event->data.begin(), event->data.end());
  std::int32_t number = 0;
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), number);
  if (parsed.ec != std::errc() || number < 1 ||
      base_before(number) != Bytes(text.begin(), text.end())) {
    throw std::runtime_error("log '" + path.string() + "': its " + kBaseChannel +
                             " does not tell the number of the next file");
  }
  return number;
}

}  // namespace kintsugi::mapper
