#include "mapper/session/log_marks.hpp"

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string_view>

#include "lcmtypes/log/log_format.hpp"
#include "lcmtypes/log/session_log.hpp"

namespace kintsugi::mapper {
namespace {

/// Whether `is_wanted` holds for one of the places behind `position` that a sync word begins.
bool any_event_behind(const std::filesystem::path& path, std::int64_t position,
                      const std::function<bool(std::int64_t)>& is_wanted) {
  std::ifstream file(path, std::ios::binary);
  file.seekg(position + 1);
  std::uint32_t word = 0;
  for (char byte = 0; file.get(byte);) {
    word = word << 8U | static_cast<std::uint8_t>(byte);
    if (word == log_format::kSyncWord && is_wanted(std::int64_t{file.tellg()} - 4)) return true;
  }
  return false;
}

bool is_mark(std::ifstream& file, std::int64_t position) {
  const Bytes data = mark_at(position);
  const std::string_view channel = kMarkChannel;
  std::string found(channel.size() + data.size(), '\0');
  file.clear();
  file.seekg(position + log_format::kEventHeaderBytes);
  file.read(found.data(), std::ssize(found));
  return file.good() && found.starts_with(channel) &&
         std::ranges::equal(
             std::string_view(found).substr(channel.size()), data,
             [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; });
}

}  // namespace

Bytes mark_at(std::int64_t position) {
  // With an end of its own, so that no mark is the beginning of another one.
  const std::string text = std::to_string(position) + '\n';
  return {text.begin(), text.end()};
}

void check_mark(const LogEvent& event, std::int64_t position) {
  if (std::ranges::equal(event.data, mark_at(position))) return;
  throw std::runtime_error(std::string("a mark on ") + kMarkChannel + " that is not of its place");
}

bool has_event_behind(const std::filesystem::path& path, std::int64_t position) {
  return any_event_behind(path, position, [](std::int64_t) { return true; });
}

bool has_mark_behind(const std::filesystem::path& path, std::int64_t position) {
  std::ifstream file(path, std::ios::binary);
  return any_event_behind(path, position,
                          [&file](std::int64_t place) { return is_mark(file, place); });
}

}  // namespace kintsugi::mapper
