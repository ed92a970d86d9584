#include "mapper/openni2_driver/formats/ros_bag_index.hpp"

#include <cstdint>
#include <cstring>
#include <map>
#include <stdexcept>
#include <string>

#include "mapper/openni2_driver/formats/binary_file.hpp"

namespace kintsugi::mapper {
namespace {

constexpr std::int64_t kMagicBytes = 13;  // "#ROSBAG V2.0\n"
constexpr std::int64_t kEntryBytes = 12;  // time (8) and offset (4) of a message
constexpr char kChunk = 0x05;
constexpr char kIndexData = 0x04;
/// An image of 16 K x 16 K fits; the library takes memory for what a chunk claims to unpack to.
constexpr std::int64_t kMaxChunkBytes = std::int64_t{1} << 30U;

[[noreturn]] void fail(std::int64_t place, const std::string& what) {
  throw std::runtime_error("its index is damaged: byte " + std::to_string(place) + ": " + what);
}

/// The fields of the header of a record, which begins at the place of the file.
std::map<std::string, std::string> read_fields(BinaryFile& file) {
  const std::int64_t place = file.place();
  const auto bytes = file.read_bytes(file.read<std::uint32_t>());
  std::map<std::string, std::string> fields;
  for (std::size_t at = 0; at < bytes.size();) {
    std::uint32_t length = 0;
    if (bytes.size() - at < sizeof length) fail(place, "a field of a record ends early");
    std::memcpy(&length, bytes.data() + at, sizeof length);
    at += sizeof length;
    if (bytes.size() - at < length) fail(place, "a field of a record ends early");
    const std::string field(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                            bytes.begin() + static_cast<std::ptrdiff_t>(at + length));
    const std::size_t sign = field.find('=');
    if (sign == std::string::npos) fail(place, "a field of a record has no value");
    fields.emplace(field.substr(0, sign), field.substr(sign + 1));
    at += length;
  }
  return fields;
}

std::uint32_t number_in(const std::map<std::string, std::string>& fields, const char* name,
                        std::int64_t place) {
  const auto field = fields.find(name);
  std::uint32_t number = 0;
  if (field == fields.end() || field->second.size() != sizeof number) {
    fail(place, std::string("a record has no ") + name);
  }
  std::memcpy(&number, field->second.data(), sizeof number);
  return number;
}

struct Chunk {
  std::int64_t begin = 0;  ///< of its data in the file
  std::int64_t size = 0;   ///< unpacked
  bool is_packed = false;
};

/// A message within a chunk that is not packed: header and data, each after its length.
void check_message(BinaryFile& file, const Chunk& chunk, std::int64_t offset) {
  for (int part = 0; part < 2; ++part) {
    constexpr std::int64_t kLengthBytes = 4;
    if (chunk.size - offset < kLengthBytes) fail(chunk.begin + offset, "a message ends early");
    file.seek(chunk.begin + offset);
    offset += kLengthBytes + std::int64_t{file.read<std::uint32_t>()};
    if (offset > chunk.size) fail(chunk.begin, "a message is longer than its chunk");
  }
}

}  // namespace

void check_bag_index(const std::filesystem::path& path) {
  BinaryFile file(path);
  file.seek(kMagicBytes);
  Chunk chunk;  // the last one, which the index that follows is of
  while (file.bytes_left() > 0) {
    const std::int64_t place = file.place();
    const auto fields = read_fields(file);
    const std::int64_t bytes = file.read<std::uint32_t>();
    const std::int64_t begin = file.place();
    const auto op = fields.find("op");
    if (op == fields.end() || op->second.size() != 1) fail(place, "a record has no op");
    if (op->second[0] == kChunk) {
      const auto packing = fields.find("compression");
      chunk = {begin, number_in(fields, "size", place),
               packing != fields.end() && packing->second != "none"};
      if (chunk.size > kMaxChunkBytes || (!chunk.is_packed && chunk.size > bytes)) {
        fail(place, "a chunk claims " + std::to_string(chunk.size) + " bytes");
      }
    } else if (op->second[0] == kIndexData) {
      const std::int64_t count = number_in(fields, "count", place);
      if (count * kEntryBytes > bytes) fail(place, "a list of messages ends early");
      for (std::int64_t i = 0; i < count; ++i) {
        file.seek(begin + i * kEntryBytes + 8);
        const std::int64_t offset = file.read<std::uint32_t>();
        if (offset >= chunk.size) fail(place, "a message is beyond the end of its chunk");
        if (!chunk.is_packed) check_message(file, chunk, offset);
      }
    }
    file.seek(begin + bytes);
  }
}

}  // namespace kintsugi::mapper
