#include "mapper/session/log_names.hpp"

#include <algorithm>
#include <charconv>
#include <string>
#include <system_error>

namespace kintsugi::mapper {

namespace fs = std::filesystem;

fs::path numbered(const fs::path& path, int number) {
  if (number == 0) return path;
  return path.parent_path() /
         (path.stem().string() + '.' + std::to_string(number) + path.extension().string());
}

fs::path partial(const fs::path& path) {
  return path.parent_path() / (path.stem().string() + ".partial" + path.extension().string());
}

int last_number(const fs::path& path) {
  const std::string begin = path.stem().string() + ".";
  const std::string end = path.extension().string();
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  int last = 0;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(begin) || !name.ends_with(end) ||
        name.size() <= begin.size() + end.size()) {
      continue;
    }
    const char* const digits_end = name.data() + (name.size() - end.size());
    int number = 0;
    const auto parsed = std::from_chars(name.data() + begin.size(), digits_end, number);
    if (parsed.ec == std::errc() && parsed.ptr == digits_end) last = std::max(last, number);
  }
  return last;
}

fs::path base_in_work(const fs::path& path) {
  return path.parent_path() / ("." + path.stem().string() + ".base" + path.extension().string());
}

void remove_left(const fs::path& path, int next) {
  std::error_code ignored;
  fs::remove(base_in_work(path), ignored);
  for (int number = next - 1; number > 0 && fs::remove(numbered(path, number), ignored); --number) {
  }
}

}  // namespace kintsugi::mapper
