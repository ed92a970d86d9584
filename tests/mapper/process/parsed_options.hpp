#pragma once
// Command lines of the mapper for the tests of its options.

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include <unistd.h>

#include "mapper/process/options.hpp"

namespace kintsugi::mapper::testing {

inline std::variant<Options, int> parse(std::vector<const char*> flags) {
  flags.insert(flags.begin(), "kintsugi-mapper");
  return parse_options(static_cast<int>(flags.size()), flags.data());
}

inline Options options_of(const std::vector<const char*>& flags) {
  return std::get<Options>(parse(flags));
}

inline std::string error_of(const std::vector<const char*>& flags) {
  try {
    parse(flags);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "no error";
}

class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& text)
      : path_(std::filesystem::temp_directory_path() /
              ("kintsugi_options_" + std::to_string(::getpid()) + ".txt")) {
    std::ofstream(path_) << text;
  }
  ~TemporaryFile() { std::filesystem::remove(path_); }
  std::string path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace kintsugi::mapper::testing
