#include "segmenter/io/formats/las_cloud.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <vector>

namespace kintsugi::segmenter {
namespace {

static_assert(std::endian::native == std::endian::little, "LAS files are little-endian");

template <class T>
T read_at(const char* bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes + offset, sizeof value);
  return value;
}

/// A number of a point record that becomes a column as it is.
struct Attribute {
  const char* name;
  ScalarType type;
  std::size_t offset;
};

/// A point format: its attributes behind X, Y and Z, and where its colour is.
struct PointFormat {
  std::vector<Attribute> attributes;
  std::size_t color_offset = 0;  // 0: none
  std::size_t num_bytes = 0;     // of a record without extra bytes
};

/// ASPRS LAS 1.4 R15, tables 7 to 17.
PointFormat point_format(unsigned number) {
  constexpr std::array<std::size_t, 11> kBytes{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
  constexpr std::array<std::size_t, 11> kColor{0, 0, 20, 28, 0, 28, 0, 30, 30, 0, 30};
  constexpr std::array<std::size_t, 11> kGpsTime{0, 20, 0, 20, 20, 20, 22, 22, 22, 22, 22};
  PointFormat format{.attributes = {{"intensity", ScalarType::kUint16, 12}},
                     .color_offset = kColor.at(number),
                     .num_bytes = kBytes.at(number)};
  auto& attributes = format.attributes;
  if (number < 6) {
    attributes.insert(attributes.end(), {{"return_flags", ScalarType::kUint8, 14},
                                         {"classification", ScalarType::kUint8, 15},
                                         {"scan_angle", ScalarType::kInt8, 16},
                                         {"user_data", ScalarType::kUint8, 17},
                                         {"point_source_id", ScalarType::kUint16, 18}});
  } else {
    attributes.insert(attributes.end(), {{"return_flags", ScalarType::kUint8, 14},
                                         {"class_flags", ScalarType::kUint8, 15},
                                         {"classification", ScalarType::kUint8, 16},
                                         {"user_data", ScalarType::kUint8, 17},
                                         {"scan_angle", ScalarType::kInt16, 18},
                                         {"point_source_id", ScalarType::kUint16, 20}});
  }
  if (kGpsTime.at(number) > 0) {
    attributes.push_back({"gps_time", ScalarType::kFloat64, kGpsTime.at(number)});
  }
  if (number == 8 || number == 10) attributes.push_back({"nir", ScalarType::kUint16, 36});
  return format;
}

struct Header {
  unsigned format = 0;
  std::size_t data_offset = 0;
  std::size_t record_bytes = 0;
  std::uint64_t num_points = 0;
  std::array<double, 3> scale{};
  std::array<double, 3> offset{};
};

Header parse_header(std::string_view bytes, const std::string& name) {
  constexpr std::size_t kMinBytes = 227;  // version 1.0
  constexpr std::size_t kMinBytesVersion4 = 375;
  constexpr unsigned kMaxFormat = 10;
  constexpr unsigned kCompressed = 0xC0;  // these bits of the format are set in LAZ files
  const auto fail = [&](std::size_t byte, const std::string& what) {
    throw std::runtime_error(name + ": byte " + std::to_string(byte) + ": " + what);
  };
  if (!bytes.starts_with("LASF")) fail(0, "not a LAS file: expected 'LASF'");
  if (bytes.size() < kMinBytes) fail(bytes.size(), "the file ends inside the LAS header");
  const char* const data = bytes.data();
  Header header;
  header.format = read_at<std::uint8_t>(data, 104);
  if ((header.format & kCompressed) != 0) {
    fail(104,
         "the points are compressed (LAZ), expected LAS: convert the file, for instance with "
         "'laszip -i IN.laz -o OUT.las' or 'pdal translate IN.laz OUT.las'");
  }
  if (header.format > kMaxFormat) {
    fail(104, "point format " + std::to_string(header.format) + ", expected 0 to 10");
  }
  header.data_offset = read_at<std::uint32_t>(data, 96);
  header.record_bytes = read_at<std::uint16_t>(data, 105);
  header.num_points = read_at<std::uint32_t>(data, 107);
  const unsigned minor_version = read_at<std::uint8_t>(data, 25);
  if (minor_version >= 4 && bytes.size() >= kMinBytesVersion4) {
    header.num_points = std::max(header.num_points, read_at<std::uint64_t>(data, 247));
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    header.scale.at(axis) = read_at<double>(data, 131 + 8 * axis);
    header.offset.at(axis) = read_at<double>(data, 155 + 8 * axis);
  }
  const std::size_t min_record_bytes = point_format(header.format).num_bytes;
  if (header.record_bytes < min_record_bytes) {
    fail(105, "points of " + std::to_string(header.record_bytes) + " bytes, expected at least " +
                  std::to_string(min_record_bytes) + " in format " + std::to_string(header.format));
  }
  const std::size_t available =
      bytes.size() - std::min<std::size_t>(header.data_offset, bytes.size());
  if (header.num_points > available / header.record_bytes) {
    fail(header.data_offset, "the header claims " + std::to_string(header.num_points) +
                                 " points of " + std::to_string(header.record_bytes) +
                                 " bytes, but " + std::to_string(available) + " bytes follow");
  }
  return header;
}

/// How many low bits of the colours are cut: 8, or 0 if all are 8-bit already.
unsigned color_shift(std::string_view records, const Header& header, std::size_t color_offset) {
  constexpr unsigned kMax8Bits = 255;
  for (std::size_t i = 0; i < header.num_points; ++i) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const std::size_t at = i * header.record_bytes + color_offset + 2 * channel;
      if (read_at<std::uint16_t>(records.data(), at) > kMax8Bits) return 8;
    }
  }
  return 0;
}

PointTable empty_table(const PointFormat& format) {
  PointTable table;
  table.place = "the header";
  for (const char* axis : {"x", "y", "z"}) table.add_field(axis, ScalarType::kFloat64);
  if (format.color_offset > 0) {
    for (const char* channel : {"red", "green", "blue"}) {
      table.add_field(channel, ScalarType::kUint8);
    }
  }
  for (const Attribute& attribute : format.attributes) {
    table.add_field(attribute.name, attribute.type);
  }
  return table;
}

}  // namespace

PointTable parse_las_cloud(std::string_view bytes, const std::string& name) {
  const Header header = parse_header(bytes, name);
  const PointFormat format = point_format(header.format);
  const std::string_view records = bytes.substr(std::min(header.data_offset, bytes.size()));
  const unsigned shift =
      format.color_offset > 0 ? color_shift(records, header, format.color_offset) : 0;
  PointTable table = empty_table(format);
  table.reserve(header.num_points);
  for (std::size_t i = 0; i < header.num_points; ++i) {
    const char* const from = records.data() + i * header.record_bytes;
    char* const to = table.append();
    auto field = table.fields().begin();
    const auto add = [&](double value) {
      write_scalar(value, field->type, to + field->offset);
      ++field;
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto steps = static_cast<double>(read_at<std::int32_t>(from, 4 * axis));
      add(steps * header.scale.at(axis) + header.offset.at(axis));
    }
    for (std::size_t channel = 0; format.color_offset > 0 && channel < 3; ++channel) {
      add(read_at<std::uint16_t>(from, format.color_offset + 2 * channel) >> shift);
    }
    for (const Attribute& attribute : format.attributes) {
      add(read_scalar(from + attribute.offset, attribute.type));
    }
  }
  return table;
}

}  // namespace kintsugi::segmenter
