#pragma once
// Writes the input to a file, for decoders that read files.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <string_view>

#include "tests/support/temporary_folder.hpp"

namespace kintsugi::fuzzing {

/// A folder of this process; scripts/fuzz-decoders removes what a crash leaves.
inline const testing::TemporaryFolder& input_folder() {
  static const testing::TemporaryFolder folder;
  return folder;
}

inline std::filesystem::path write_input(const std::string& name,
                                         std::span<const std::uint8_t> bytes) {
  std::filesystem::path path = input_folder() / name;
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), std::ssize(bytes));
  return path;
}

inline std::string_view as_text(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

inline std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace kintsugi::fuzzing
