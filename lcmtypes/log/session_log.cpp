#include "lcmtypes/log/session_log.hpp"

#include <algorithm>
#include <charconv>
#include <stdexcept>
#include <string>
#include <system_error>

#include "lcmtypes/log/log_reader.hpp"

namespace kintsugi {

namespace fs = std::filesystem;

fs::path numbered(const fs::path& path, int number) {
  if (number == 0) return path;
  return path.parent_path() /
         (path.stem().string() + '.' + std::to_string(number) + path.extension().string());
}

int last_number(const fs::path& path) {
  const std::string begin = path.stem().string() + ".";
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  int last = 0;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(begin)) continue;
    int number = 0;
    std::from_chars(name.data() + begin.size(), name.data() + name.size(), number);
    if (name == numbered(path, number).filename()) last = std::max(last, number);
  }
  return last;
}

std::vector<int> numbers_of_files(const fs::path& path) {
  const int last = last_number(path);
  std::vector<int> numbers{0};
  if (last == 0) return numbers;
  const auto check_is_there = [&](int number) {
    std::error_code ignored;
    if (!fs::exists(numbered(path, number), ignored)) {
      throw std::runtime_error("log '" + numbered(path, number).string() + "' is missing, '" +
                               numbered(path, last).string() + "' is there");
    }
  };
  check_is_there(0);
  for (int number = next_after_base(path); number <= last; ++number) {
    check_is_there(number);
    numbers.push_back(number);
  }
  return numbers;
}

Bytes base_before(std::int32_t next_number) {
  const std::string text = std::to_string(next_number) + '\n';
  return {text.begin(), text.end()};
}

std::int32_t next_after_base(const fs::path& path) {
  std::error_code ignored;
  if (fs::file_size(path, ignored) == 0) return 1;  // killed before the first event
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

bool is_session_log(const fs::path& path) {
  LogReader reader(path, MessageTrust{.trusts_all = true});
  const auto event = reader.next();
  return event && (event->channel == kOptionsChannel || event->channel == kBaseChannel ||
                   event->channel == kMarkChannel);
}

}  // namespace kintsugi
