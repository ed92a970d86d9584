#pragma once
// The header of a PCD file (Point Cloud Library).

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "segmenter/io/points/point_table.hpp"

namespace kintsugi::segmenter {

enum class PcdData { kAscii, kBinary, kBinaryCompressed };

/// What becomes of a number of a point.
enum class PcdUse { kNumber, kPackedColor, kPackedColorAlpha, kPadding };

/// One number of a point: a field, or one of several of a field with COUNT.
struct PcdValue {
  PcdUse use = PcdUse::kNumber;
  char kind = 'F';                  ///< F, I or U
  std::size_t size = 4;             ///< bytes in a binary file: 1, 2, 4 or 8
  std::size_t num_repetitions = 1;  ///< of padding, which no one reads
};

struct PcdHeader {
  std::vector<PcdValue> values;  ///< of a point, in the order of the file
  PointTable table;              ///< without points: a column for each number, four for a colour
  std::vector<std::size_t> field_bytes;   ///< of each field with its COUNT
  std::vector<std::size_t> field_values;  ///< entries in `values` of each field
  std::size_t num_points = 0;             ///< as the header claims
  std::size_t point_bytes = 0;            ///< in a binary file
  PcdData data = PcdData::kAscii;
  std::size_t num_bytes = 0;  ///< offset at which the data begin
  std::int64_t num_lines = 0;
};

/// Reads the header at the beginning of `bytes`. Columns get PLY's names: normal_x is nx, the
/// packed rgb is red green blue, rgba also alpha. 64-bit integers become double.
///
/// @throws std::runtime_error naming the file, the line, what was found and what was expected
PcdHeader parse_pcd_header(std::string_view bytes, const std::string& name);

}  // namespace kintsugi::segmenter
