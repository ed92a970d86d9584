#pragma once
// Files of records in their memory layout, little-endian, with a CRC-32 at the end.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <istream>
#include <memory>
#include <ostream>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace kintsugi::segmenter {

static_assert(std::endian::native == std::endian::little,
              "records are written in their memory layout");

/// Writes records to a stream that throws when it fails.
class RecordWriter {
 public:
  explicit RecordWriter(std::ostream& out) : out_(out) {}

  template <class Record>
  void write_all(std::span<const Record> records) {
    static_assert(std::is_trivially_copyable_v<Record>);
    write_bytes(std::as_bytes(records));
  }
  template <class Record>
  void write(const Record& record) {
    write_all(std::span<const Record>(&record, 1));
  }
  /// The CRC-32 of everything so far.
  void write_checksum() { write(crc_); }

 private:
  void write_bytes(std::span<const std::byte> bytes);

  std::ostream& out_;
  std::uint32_t crc_ = 0;
};

/// Reads the records of a file in order. Every error is a std::runtime_error that names the file.
class RecordReader {
 public:
  /// @throws std::runtime_error when `path` cannot be read
  explicit RecordReader(const std::filesystem::path& path);
  /// Reads bytes that are in memory. @param name what errors call them
  RecordReader(std::span<const std::uint8_t> bytes, std::string name);

  std::uint64_t size() const { return size_; }
  /// Bytes from the current position to the end.
  std::uint64_t left() const { return size_ - position_; }

  /// @throws std::runtime_error, before anything is allocated, when the file is too short
  template <class Record>
  std::vector<Record> read_all(std::uint64_t count) {
    static_assert(std::is_trivially_copyable_v<Record>);
    require(count, sizeof(Record));
    std::vector<Record> records(count);
    read_bytes(std::as_writable_bytes(std::span(records)));
    return records;
  }
  template <class Record>
  Record read() {
    require(1, sizeof(Record));
    Record record;
    read_bytes(std::as_writable_bytes(std::span(&record, 1)));
    return record;
  }

  /// Keeps the current position.
  /// @throws std::runtime_error unless the last four bytes are the CRC-32 of all before them
  void check_checksum();

  /// @throws std::runtime_error with the file, the current position and `reason`
  [[noreturn]] void fail(const std::string& reason) const;

 private:
  void require(std::uint64_t count, std::size_t record_bytes) const;
  void read_bytes(std::span<std::byte> bytes);

  std::string name_;
  std::unique_ptr<std::istream> in_;
  std::uint64_t size_ = 0;
  std::uint64_t position_ = 0;
};

}  // namespace kintsugi::segmenter
