#include "mapper/source/openni2/oni_file.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <vector>

namespace kintsugi::mapper {
namespace {

namespace fs = std::filesystem;

// File: a header, then records; little-endian, packed. A record: magic, type, node id, bytes of
// header and fields together, bytes of payload (u32 each), position of the record it replaces (u32
// before version 1.0.1, u64 since), fields, payload.
constexpr std::uint32_t kFileMagic = 0x3031494E;    // "NI10"
constexpr std::uint32_t kRecordMagic = 0x0052494E;  // "NIR"
constexpr std::uint64_t kFileHeaderSize = 24;
constexpr std::uint64_t kMaxNodePosition = 20;
constexpr std::uint32_t kMaxNodes = 1000;  // a hostile header would make the driver allocate more
constexpr std::uint32_t kMaxFieldsSize = 600 * 1024;

enum RecordType : std::uint32_t {
  kNodeAddedOld = 0x02,
  kNewData = 0x0A,
  kEnd = 0x0B,
  kNodeAdded105 = 0x0C,
  kNodeAdded = 0x0D,
};

// What follows a node's name, type and codec in the record that announces it.
constexpr std::uint64_t kSeekTableOffset = 4 + 8 + 8;  // after frames, first and last time

template <typename T>
T read_at(const std::vector<char>& bytes, std::size_t offset) {
  T value{};
  if (offset + sizeof(T) <= bytes.size()) std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

struct RecordHeader {
  std::uint32_t type = 0;
  std::uint32_t node = 0;
  std::uint32_t fields_size = 0;  ///< with the header
  std::uint32_t payload_size = 0;
};

class Scanner {
 public:
  explicit Scanner(const fs::path& file) : file_(file) {
    if (!fs::exists(file)) fail("no such file");
    if (!fs::is_regular_file(file)) fail("not a file");
    size_ = fs::file_size(file);
    if (size_ == 0) fail("is empty, expected a .oni recording");
    stream_.open(file, std::ios::binary);
    if (!stream_) fail("cannot be read");
  }

  OniFile scan() {
    check_file_header();
    contents_.good_bytes = kFileHeaderSize;
    bool ended = false;
    while (!ended && contents_.damage.empty()) ended = take_record();
    if (contents_.frames(OniFile::Node::Kind::kDepth) == 0) {
      fail("holds no depth image" +
           (contents_.damage.empty() ? "" : " before it ends: " + contents_.damage));
    }
    return contents_;
  }

 private:
  void check_file_header() {
    const std::vector<char> header = read(0, kFileHeaderSize);
    if (read_at<std::uint32_t>(header, 0) != kFileMagic) {
      fail("is no .oni recording: it does not begin with NI10");
    }
    if (header.size() < kFileHeaderSize) fail("is cut off in its header");
    const std::array version = {int{read_at<std::uint8_t>(header, 4)},
                                int{read_at<std::uint8_t>(header, 5)},
                                int{read_at<std::uint16_t>(header, 6)}};
    const bool known = version[0] == 1 && version[1] == 0 && version[2] <= 1;
    if (!known) {
      fail("is of version " + std::to_string(version[0]) + "." + std::to_string(version[1]) + "." +
           std::to_string(version[2]) + ", expected 1.0.0 or 1.0.1");
    }
    record_header_size_ = version[2] == 0 ? 24 : 28;
    contents_.can_be_mended = version[2] >= 1;
    // A recorder writes the number of nodes when it finishes; until then it is 0.
    max_node_ = read_at<std::uint32_t>(header, kMaxNodePosition);
    if (max_node_ > kMaxNodes) {
      fail("announces " + std::to_string(max_node_) + " streams, expected at most " +
           std::to_string(kMaxNodes));
    }
  }

  /// True at the end record.
  bool take_record() {
    const std::uint64_t position = contents_.good_bytes;
    const std::vector<char> bytes = read(position, record_header_size_);
    if (bytes.empty()) return damaged(position, "it ends without an end record");
    if (bytes.size() < record_header_size_) return damaged(position, "it is cut off");
    if (read_at<std::uint32_t>(bytes, 0) != kRecordMagic) {
      return damaged(position, "what follows is no record");
    }
    const RecordHeader record{.type = read_at<std::uint32_t>(bytes, 4),
                              .node = read_at<std::uint32_t>(bytes, 8),
                              .fields_size = read_at<std::uint32_t>(bytes, 12),
                              .payload_size = read_at<std::uint32_t>(bytes, 16)};
    if (record.fields_size < record_header_size_ || record.fields_size > kMaxFieldsSize) {
      return damaged(position, "what follows is a record of an impossible size");
    }
    const std::uint64_t end = position + record.fields_size + record.payload_size;
    if (end > size_) return damaged(position, "it is cut off");
    const bool node_known = take_contents(record, position);
    if (!node_known) return damaged(position, "what follows does not fit the streams announced");
    contents_.good_bytes = end;
    return record.type == kEnd;
  }

  bool take_contents(const RecordHeader& record, std::uint64_t position) {
    if (record.type == kNewData) {
      const auto node = contents_.nodes.find(record.node);
      if (node == contents_.nodes.end()) return false;
      ++node->second.frames;
    } else if (record.type == kNodeAdded || record.type == kNodeAdded105 ||
               record.type == kNodeAddedOld) {
      const auto node = announced_node(record, position);
      if (!node) return false;
      contents_.nodes[record.node] = *node;
    }
    return true;
  }

  std::optional<OniFile::Node> announced_node(const RecordHeader& record, std::uint64_t position) {
    const std::vector<char> fields = read(position, record.fields_size);
    const std::size_t name_size = read_at<std::uint32_t>(fields, record_header_size_);
    const std::size_t type_position = record_header_size_ + 4 + name_size;
    const bool whole = type_position + 8 + kSeekTableOffset + 8 <= record.fields_size;
    if (record.node > kMaxNodes || (contents_.can_be_mended && !whole)) return std::nullopt;
    OniFile::Node node;
    node.fields_position = position + type_position + 8;  // after type and codec
    const auto type = read_at<std::uint32_t>(fields, type_position);
    if (type == 2) node.kind = OniFile::Node::Kind::kDepth;
    if (type == 3) node.kind = OniFile::Node::Kind::kColor;
    const auto announced = read_at<std::uint32_t>(fields, type_position + 8);
    constexpr std::uint32_t kNotFinished = 0xFFFFFFFF;
    node.frames_announced = announced == kNotFinished ? 0 : announced;
    return node;
  }

  bool damaged(std::uint64_t position, const std::string& what) {
    contents_.damage =
        what + " at byte " + std::to_string(position) + " of " + std::to_string(size_);
    return false;
  }

  std::vector<char> read(std::uint64_t position, std::uint64_t size) {
    std::vector<char> bytes(std::min(size, size_ - std::min(position, size_)));
    stream_.seekg(static_cast<std::streamoff>(position));
    stream_.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (!stream_) fail("reading it failed at byte " + std::to_string(position));
    return bytes;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error(file_.string() + ": " + what);
  }

  fs::path file_;
  std::ifstream stream_;
  std::uint64_t size_ = 0;
  std::uint64_t record_header_size_ = 0;
  std::uint32_t max_node_ = 0;
  OniFile contents_;
};

template <typename T>
void write_at(std::fstream& stream, std::uint64_t position, T value) {
  stream.seekp(static_cast<std::streamoff>(position));
  stream.write(reinterpret_cast<const char*>(&value), sizeof(value));
}

}  // namespace

int OniFile::frames(Node::Kind kind) const {
  int sum = 0;
  for (const auto& [id, node] : nodes) sum += node.kind == kind ? node.frames : 0;
  return sum;
}

std::uint32_t OniFile::frames_announced(Node::Kind kind) const {
  std::uint32_t sum = 0;
  for (const auto& [id, node] : nodes) sum += node.kind == kind ? node.frames_announced : 0;
  return sum;
}

bool is_oni_file(const std::filesystem::path& file) {
  if (std::filesystem::is_directory(file)) return false;
  std::ifstream stream(file, std::ios::binary);
  std::uint32_t magic = 0;
  stream.read(reinterpret_cast<char*>(&magic), sizeof(magic));
  return stream ? magic == kFileMagic : file.extension() == ".oni";
}

OniFile scan_oni_file(const fs::path& file) { return Scanner(file).scan(); }

void write_mended_copy(const fs::path& file, const OniFile& contents, const fs::path& copy) {
  if (!contents.can_be_mended) {
    throw std::runtime_error(file.string() + ": is damaged (" + contents.damage +
                             ") and of version 1.0.0, which cannot be read in part");
  }
  fs::copy_file(file, copy, fs::copy_options::overwrite_existing);
  fs::permissions(copy, fs::perms::owner_read | fs::perms::owner_write);
  fs::resize_file(copy, contents.good_bytes);
  std::fstream stream(copy, std::ios::binary | std::ios::in | std::ios::out);

  write_at(stream, kMaxNodePosition, contents.nodes.rbegin()->first);
  for (const auto& [id, node] : contents.nodes) {
    write_at(stream, node.fields_position, static_cast<std::uint32_t>(node.frames));
    write_at(stream, node.fields_position + kSeekTableOffset, std::uint64_t{0});
  }
  std::uint64_t end = contents.good_bytes;
  for (const std::uint32_t word : {kRecordMagic, std::uint32_t{kEnd}, 0U, 28U, 0U, 0U, 0U}) {
    write_at(stream, end, word);
    end += sizeof(word);
  }
  stream.close();
  if (!stream) throw std::runtime_error(copy.string() + ": cannot be written");
}

}  // namespace kintsugi::mapper
