#include "segmenter/io/formats/pcd_cloud.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <lzf.h>

#include "segmenter/io/formats/pcd_header.hpp"
#include "segmenter/io/points/text_words.hpp"

namespace kintsugi::segmenter {
namespace {

static_assert(std::endian::native == std::endian::little, "binary PCD files are little-endian");

std::uint32_t read_u32(const char* bytes) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

template <class T>
double read_integer64(const char* bytes) {
  T value = 0;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

/// The number at `bytes`, with 64-bit integers rounded to double.
double read_number(const char* bytes, const PcdValue& value, ScalarType column) {
  if (value.size == 8 && value.kind == 'I') return read_integer64<std::int64_t>(bytes);
  if (value.size == 8 && value.kind == 'U') return read_integer64<std::uint64_t>(bytes);
  return read_scalar(bytes, column);
}

/// Fills the records of a table, number by number.
class RecordFiller {
 public:
  explicit RecordFiller(PointTable& table) : table_(table) {}

  void begin_point() {
    record_ = table_.append();
    column_ = 0;
  }
  void add(double number) {
    const PointField& field = table_.fields()[column_++];
    write_scalar(number, field.type, record_ + field.offset);
  }
  ScalarType next_type() const { return table_.fields()[column_].type; }
  /// @param packed alpha, red, green, blue, from the highest byte
  void add_color(std::uint32_t packed, bool has_alpha) {
    constexpr std::uint32_t kByte = 0xFF;
    for (const unsigned shift : {16U, 8U, 0U}) add((packed >> shift) & kByte);
    if (has_alpha) add((packed >> 24U) & kByte);
  }

 private:
  PointTable& table_;
  char* record_ = nullptr;
  std::size_t column_ = 0;
};

class PcdReader {
 public:
  PcdReader(std::string_view bytes, const std::string& name)
      : bytes_(bytes), name_(name), header_(parse_pcd_header(bytes, name)) {}

  PointTable read() {
    switch (header_.data) {
      case PcdData::kAscii:
        read_ascii();
        break;
      case PcdData::kBinary:
        check_data_bytes(bytes_.size() - header_.num_bytes);
        read_binary(bytes_.substr(header_.num_bytes), row_places());
        break;
      case PcdData::kBinaryCompressed:
        read_compressed();
        break;
    }
    return std::move(header_.table);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error(name_ + ": " + what);
  }

  /// Where the numbers of field `f` of point i are: begin + i * step.
  struct Place {
    std::size_t begin = 0;
    std::size_t step = 0;
  };

  void check_data_bytes(std::size_t available) const {
    if (header_.point_bytes == 0) fail("line 1: the PCD header has no FIELDS");
    if (header_.num_points <= available / header_.point_bytes) return;
    fail("byte " + std::to_string(header_.num_bytes) + ": the header claims " +
         std::to_string(header_.num_points) + " points of " + std::to_string(header_.point_bytes) +
         " bytes, but " + std::to_string(available) + " bytes follow");
  }

  /// Point after point.
  std::vector<Place> row_places() const {
    std::vector<Place> places;
    std::size_t begin = 0;
    for (const std::size_t num_bytes : header_.field_bytes) {
      places.push_back({begin, header_.point_bytes});
      begin += num_bytes;
    }
    return places;
  }

  /// All points of one field, then all of the next, as compressed data are.
  std::vector<Place> column_places() const {
    std::vector<Place> places;
    std::size_t begin = 0;
    for (const std::size_t num_bytes : header_.field_bytes) {
      places.push_back({begin, num_bytes});
      begin += num_bytes * header_.num_points;
    }
    return places;
  }

  void read_binary(std::string_view data, const std::vector<Place>& places) {
    header_.table.reserve(header_.num_points);
    RecordFiller filler(header_.table);
    for (std::size_t i = 0; i < header_.num_points; ++i) {
      filler.begin_point();
      std::size_t next = 0;
      for (std::size_t f = 0; f < places.size(); ++f) {
        const char* at = data.data() + places[f].begin + i * places[f].step;
        for (std::size_t k = 0; k < header_.field_values[f]; ++k) {
          const PcdValue& value = header_.values[next++];
          take_binary(at, value, filler);
          at += value.size;
        }
      }
    }
  }

  static void take_binary(const char* at, const PcdValue& value, RecordFiller& filler) {
    switch (value.use) {
      case PcdUse::kNumber:
        filler.add(read_number(at, value, filler.next_type()));
        break;
      case PcdUse::kPackedColor:
      case PcdUse::kPackedColorAlpha:
        filler.add_color(read_u32(at), value.use == PcdUse::kPackedColorAlpha);
        break;
      case PcdUse::kPadding:
        break;
    }
  }

  /// Two numbers, of bytes with and without compression, and the compressed bytes.
  void read_compressed() {
    constexpr std::size_t kSizesBytes = 8;
    // LZF makes at most 264 bytes of 3.
    constexpr std::size_t kMaxExpansion = 88;
    const std::string place = "byte " + std::to_string(header_.num_bytes) + ": ";
    const std::string_view data = bytes_.substr(header_.num_bytes);
    if (data.size() < kSizesBytes) fail(place + "the file ends before the compressed data");
    const std::size_t packed_bytes = read_u32(data.data());
    const std::size_t plain_bytes = read_u32(data.data() + 4);
    if (packed_bytes > data.size() - kSizesBytes || plain_bytes > packed_bytes * kMaxExpansion) {
      fail(place + "claims " + std::to_string(packed_bytes) + " compressed bytes that hold " +
           std::to_string(plain_bytes) + ", but " + std::to_string(data.size() - kSizesBytes) +
           " bytes follow");
    }
    check_data_bytes(plain_bytes);
    if (header_.num_points == 0) return;
    std::vector<char> plain(plain_bytes);
    const unsigned num_written =
        lzf_decompress(data.data() + kSizesBytes, static_cast<unsigned>(packed_bytes), plain.data(),
                       static_cast<unsigned>(plain_bytes));
    if (num_written != plain_bytes) fail(place + "the compressed data are damaged");
    read_binary({plain.data(), plain.size()}, column_places());
  }

  void read_ascii() {
    std::size_t position = header_.num_bytes;
    std::int64_t line_number = header_.num_lines;
    RecordFiller filler(header_.table);
    while (position < bytes_.size()) {
      const std::size_t end = std::min(bytes_.find('\n', position), bytes_.size());
      const auto words = split_words(trimmed(bytes_.substr(position, end - position)));
      position = end + 1;
      ++line_number;
      if (words.empty()) continue;
      filler.begin_point();
      read_words(words, "line " + std::to_string(line_number) + ": ", filler);
    }
    if (header_.table.size() == header_.num_points) return;
    fail("line " + std::to_string(header_.num_lines) + ": the header claims " +
         std::to_string(header_.num_points) + " points, but " +
         std::to_string(header_.table.size()) + " lines follow");
  }

  void read_words(const std::vector<std::string_view>& words, const std::string& place,
                  RecordFiller& filler) const {
    std::size_t next = 0;
    const auto take = [&] {
      if (next == words.size()) fail(place + "fewer numbers than the header declares");
      const std::optional<double> number = parse_number(words[next]);
      if (!number) fail(place + in_quotes(words[next]) + " is not a number");
      ++next;
      return *number;
    };
    for (const PcdValue& value : header_.values) {
      if (value.use == PcdUse::kNumber) {
        const double number = take();
        if (!holds(filler.next_type(), number)) {
          fail(place + in_quotes(words[next - 1]) + ", expected a whole number of type " +
               std::string(name_of(filler.next_type())));
        }
        filler.add(number);
      } else if (value.use == PcdUse::kPadding) {
        for (std::size_t k = 0; k < value.num_repetitions; ++k) take();
      } else {
        filler.add_color(packed_color(take(), value.kind), value.use == PcdUse::kPackedColorAlpha);
      }
    }
    if (next != words.size()) fail(place + "more numbers than the header declares");
  }

  /// In ascii the packed colour is written as the number that its bits are, float or integer.
  static std::uint32_t packed_color(double number, char kind) {
    std::uint32_t packed = 0;
    const ScalarType type = kind == 'F'   ? ScalarType::kFloat32
                            : kind == 'I' ? ScalarType::kInt32
                                          : ScalarType::kUint32;
    write_scalar(number, type, reinterpret_cast<char*>(&packed));
    return packed;
  }

  std::string_view bytes_;
  const std::string& name_;
  PcdHeader header_;
};

}  // namespace

PointTable parse_pcd_cloud(std::string_view bytes, const std::string& name) {
  return PcdReader(bytes, name).read();
}

}  // namespace kintsugi::segmenter
