#include "segmenter/io/points/file_bytes.hpp"

#include <fstream>
#include <stdexcept>
#include <system_error>

namespace kintsugi::segmenter {

std::string read_file_bytes(const std::filesystem::path& path) {
  const std::string name = path.string();
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    throw std::runtime_error(name + ": no such file");
  }
  if (!std::filesystem::is_regular_file(path, error)) {
    throw std::runtime_error(name + ": not a regular file");
  }
  std::string bytes(std::filesystem::file_size(path), '\0');
  std::ifstream file(path, std::ios::binary);
  if (!file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) {
    throw std::runtime_error(name + ": cannot be read to its end");
  }
  return bytes;
}

}  // namespace kintsugi::segmenter
