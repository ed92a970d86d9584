#pragma once
// Small clouds in each format, written by the tests themselves.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <lzf.h>

namespace kintsugi::segmenter::testing {

/// The bytes of a value as they are in memory.
template <class T>
std::string bytes_of(const T& value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

/// A point as these files have it.
struct ExamplePoint {
  std::array<double, 3> position{};
  std::array<std::uint8_t, 3> color{};
};

/// Far from the origin, so that float32 would lose digits.
inline std::vector<ExamplePoint> example_points() {
  return {{{691'000.125, 5'334'000.5, 512.75}, {255, 0, 1}},
          {{691'000.25, 5'334'001.5, 512.875}, {10, 20, 30}},
          {{691'000.375, 5'334'002.5, -1.0}, {0, 0, 0}}};
}

// ---- NPY

inline std::string npy_header(const std::string& type, const std::string& shape,
                              bool fortran = false) {
  std::string dictionary = "{'descr': '" + type +
                           "', 'fortran_order': " + (fortran ? "True" : "False") + ", 'shape': (" +
                           shape + "), }\n";
  return "\x93NUMPY\x01" + std::string(1, '\0') +
         bytes_of(static_cast<std::uint16_t>(dictionary.size())) + dictionary;
}

/// N x 6 doubles: position and colour.
inline std::string npy_cloud() {
  std::string bytes = npy_header("<f8", "3, 6");
  for (const ExamplePoint& point : example_points()) {
    for (const double coordinate : point.position) bytes += bytes_of(coordinate);
    for (const double channel : point.color) bytes += bytes_of(channel);
  }
  return bytes;
}

// ---- PCD

inline std::uint32_t packed_color(const ExamplePoint& point) {
  return point.color[0] << 16U | point.color[1] << 8U | point.color[2];
}

/// x y z as double, rgb, 4 bytes of padding, and two numbers called "pair".
inline std::string pcd_header(const std::string& data, const std::string& num_points = "3") {
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n"
         "FIELDS x y z rgb _ pair\nSIZE 8 8 8 4 1 2\nTYPE F F F F U I\nCOUNT 1 1 1 1 4 2\n"
         "WIDTH 3\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " +
         num_points + "\nDATA " + data + "\n";
}

inline std::vector<std::string> pcd_fields(const ExamplePoint& point) {
  return {bytes_of(point.position[0]), bytes_of(point.position[1]),
          bytes_of(point.position[2]), bytes_of(packed_color(point)),
          std::string(4, '\x7F'),      bytes_of(std::int16_t{-5}) + bytes_of(std::int16_t{7})};
}

inline std::string pcd_binary() {
  std::string bytes = pcd_header("binary");
  for (const ExamplePoint& point : example_points()) {
    for (const std::string& field : pcd_fields(point)) bytes += field;
  }
  return bytes;
}

inline std::string pcd_compressed() {
  std::string plain;
  for (std::size_t field = 0; field < 6; ++field) {
    for (const ExamplePoint& point : example_points()) plain += pcd_fields(point)[field];
  }
  std::string packed(2 * plain.size(), '\0');
  packed.resize(lzf_compress(plain.data(), static_cast<unsigned>(plain.size()), packed.data(),
                             static_cast<unsigned>(packed.size())));
  return pcd_header("binary_compressed") + bytes_of(static_cast<std::uint32_t>(packed.size())) +
         bytes_of(static_cast<std::uint32_t>(plain.size())) + packed;
}

// ---- LAS

constexpr std::array<std::size_t, 11> kLasRecordBytes{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
constexpr std::array<std::size_t, 11> kLasColorOffset{0, 0, 20, 28, 0, 28, 0, 30, 30, 0, 30};

template <class T>
void put(std::string& bytes, std::size_t offset, const T& value) {
  bytes.replace(offset, sizeof value, bytes_of(value));
}

/// In millimetres from (691000, 5334000, 0), with two extra bytes a point, and colours of 16 bits.
/// @param format of the points, 0 to 10; from 6 on the file has version 1.4
inline std::string las_cloud(unsigned format) {
  const bool is_new = format >= 6;
  const std::size_t header_bytes = is_new ? 375 : 227;
  const std::size_t record_bytes = kLasRecordBytes.at(format) + 2;
  const auto points = example_points();
  std::string header(header_bytes, '\0');
  header.replace(0, 4, "LASF");
  put(header, 24, std::uint8_t{1});
  put(header, 25, static_cast<std::uint8_t>(is_new ? 4 : 2));
  put(header, 94, static_cast<std::uint16_t>(header_bytes));
  put(header, 96, static_cast<std::uint32_t>(header_bytes));
  put(header, 104, static_cast<std::uint8_t>(format));
  put(header, 105, static_cast<std::uint16_t>(record_bytes));
  if (is_new) {
    put(header, 247, static_cast<std::uint64_t>(points.size()));
  } else {
    put(header, 107, static_cast<std::uint32_t>(points.size()));
  }
  constexpr std::array<double, 3> kOffset{691'000.0, 5'334'000.0, 0.0};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    put(header, 131 + 8 * axis, 0.001);
    put(header, 155 + 8 * axis, kOffset.at(axis));
  }
  std::string bytes = header;
  for (const ExamplePoint& point : points) {
    std::string record(record_bytes, '\0');
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double steps = (point.position.at(axis) - kOffset.at(axis)) * 1000.0;
      put(record, 4 * axis, static_cast<std::int32_t>(steps));
      const auto channel = static_cast<std::uint16_t>(256 * point.color.at(axis));
      if (kLasColorOffset.at(format) > 0) {
        put(record, kLasColorOffset.at(format) + 2 * axis, channel);
      }
    }
    put(record, 12, std::uint16_t{1234});
    put(record, is_new ? 16 : 15, std::uint8_t{6});  // classification: building
    bytes += record;
  }
  return bytes;
}

}  // namespace kintsugi::segmenter::testing
