#include "segmenter/io/record_file.hpp"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <zlib.h>

namespace kintsugi::segmenter {
namespace {

std::uint32_t extend_crc(std::uint32_t crc, std::span<const std::byte> bytes) {
  if (bytes.empty()) return crc;  // zlib takes no data for a wish to begin anew
  const auto* const data = reinterpret_cast<const Bytef*>(bytes.data());
  return static_cast<std::uint32_t>(crc32_z(crc, data, bytes.size()));
}

}  // namespace

void RecordWriter::write_bytes(std::span<const std::byte> bytes) {
  out_.write(reinterpret_cast<const char*>(bytes.data()), std::ssize(bytes));
  crc_ = extend_crc(crc_, bytes);
}

RecordReader::RecordReader(const std::filesystem::path& path)
    : name_(std::string("'") + path.string() + "'") {
  std::error_code error;
  size_ = std::filesystem::file_size(path, error);
  if (!error && !std::filesystem::is_regular_file(path)) {
    error = std::make_error_code(std::errc::invalid_argument);
  }
  if (!error) {
    in_ = std::make_unique<std::ifstream>(path, std::ios::binary);
    if (!*in_) error = std::error_code(errno, std::generic_category());
  }
  if (error) throw std::system_error(error, "cannot read " + name_);
}

RecordReader::RecordReader(std::span<const std::uint8_t> bytes, std::string name)
    : name_(std::move(name)),
      in_(std::make_unique<std::istringstream>(std::string(bytes.begin(), bytes.end()))),
      size_(bytes.size()) {}

void RecordReader::check_checksum() {
  constexpr std::size_t kPieceBytes = std::size_t{1} << 20;
  const std::uint64_t place = position_;
  require(1, sizeof(std::uint32_t));
  std::vector<std::byte> piece(std::min<std::uint64_t>(size_, kPieceBytes));
  std::uint32_t crc = 0;
  in_->seekg(0);
  for (position_ = 0; left() > sizeof(crc);) {
    const auto bytes =
        std::span(piece).first(std::min<std::uint64_t>(left() - sizeof(crc), piece.size()));
    read_bytes(bytes);
    crc = extend_crc(crc, bytes);
  }
  if (const auto expected = read<std::uint32_t>(); expected != crc) {
    fail("the checksum is " + std::to_string(expected) + ", that of the bytes before it " +
         std::to_string(crc) + ": the file is damaged");
  }
  position_ = place;
  in_->seekg(static_cast<std::streamoff>(place));
}

void RecordReader::fail(const std::string& reason) const {
  throw std::runtime_error(name_ + ", byte " + std::to_string(position_) + ": " + reason);
}

void RecordReader::require(std::uint64_t count, std::size_t record_bytes) const {
  if (count > left() / record_bytes) {
    fail("expected " + std::to_string(count) + " records of " + std::to_string(record_bytes) +
         " bytes, but the file ends after " + std::to_string(left()) + " bytes");
  }
}

void RecordReader::read_bytes(std::span<std::byte> bytes) {
  in_->read(reinterpret_cast<char*>(bytes.data()), std::ssize(bytes));
  if (!*in_) fail("cannot be read to its end");
  position_ += bytes.size();
}

}  // namespace kintsugi::segmenter
