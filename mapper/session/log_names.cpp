#include "mapper/session/log_names.hpp"

#include <string>
#include <system_error>

#include "lcmtypes/log/session_log.hpp"

namespace kintsugi::mapper {

namespace fs = std::filesystem;

fs::path partial(const fs::path& path) {
  return path.parent_path() / (path.stem().string() + ".partial" + path.extension().string());
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
