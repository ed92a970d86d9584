#pragma once

#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <type_traits>
#include <vector>

namespace kintsugi::mapper {

/// A little-endian file that is read from any place. Nothing is read, and no memory taken, beyond
/// its end.
class BinaryFile {
 public:
  /// @throws std::runtime_error naming the file when it cannot be read
  explicit BinaryFile(const std::filesystem::path& file);

  [[nodiscard]] std::int64_t size() const { return size_; }
  [[nodiscard]] std::int64_t place() const { return place_; }
  [[nodiscard]] std::int64_t bytes_left() const { return size_ - place_; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  /// @throws std::runtime_error naming file and byte when it is beyond the end
  void seek(std::int64_t place);
  void skip(std::int64_t num_bytes) { seek(place_ + num_bytes); }

  /// @throws std::runtime_error naming file and byte when the file ends before
  template <typename T>
  [[nodiscard]] T read() {
    static_assert(std::is_arithmetic_v<T> && std::endian::native == std::endian::little);
    T value{};
    read_into(&value, sizeof(T));
    return value;
  }
  [[nodiscard]] std::vector<std::uint8_t> read_bytes(std::int64_t num_bytes);

 private:
  void read_into(void* target, std::int64_t num_bytes);

  std::filesystem::path path_;
  std::ifstream stream_;
  std::int64_t size_ = 0;
  std::int64_t place_ = 0;
};

}  // namespace kintsugi::mapper
