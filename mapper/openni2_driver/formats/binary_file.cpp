#include "mapper/openni2_driver/formats/binary_file.hpp"

#include <stdexcept>
#include <string>
#include <system_error>

namespace kintsugi::mapper {

BinaryFile::BinaryFile(const std::filesystem::path& file)
    : path_(file), stream_(file, std::ios::binary) {
  std::error_code failure;  // also of a folder
  size_ = static_cast<std::int64_t>(std::filesystem::file_size(file, failure));
  if (failure || !stream_) throw std::runtime_error(file.string() + ": cannot be read");
}

void BinaryFile::seek(std::int64_t place) {
  if (place < 0 || place > size_) {
    throw std::runtime_error(path_.string() + ": ends at byte " + std::to_string(size_) +
                             ", expected more up to byte " + std::to_string(place));
  }
  place_ = place;
  stream_.clear();
  stream_.seekg(place);
}

std::vector<std::uint8_t> BinaryFile::read_bytes(std::int64_t num_bytes) {
  if (num_bytes < 0 || num_bytes > bytes_left()) {
    throw std::runtime_error(path_.string() + ": " + std::to_string(num_bytes) +
                             " bytes from byte " + std::to_string(place_) + ", but it ends at " +
                             std::to_string(size_));
  }
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(num_bytes));
  read_into(bytes.data(), num_bytes);
  return bytes;
}

void BinaryFile::read_into(void* target, std::int64_t num_bytes) {
  if (num_bytes <= bytes_left()) {
    stream_.read(static_cast<char*>(target), num_bytes);
    if (stream_) {
      place_ += num_bytes;
      return;
    }
  }
  throw std::runtime_error(path_.string() + ": ends at byte " + std::to_string(size_) +
                           ", expected " + std::to_string(num_bytes) + " bytes from byte " +
                           std::to_string(place_));
}

}  // namespace kintsugi::mapper
