#pragma once
// The header of a PLY file: its elements and their properties.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "segmenter/io/points/scalar_type.hpp"

namespace kintsugi::segmenter {

enum class PlyFormat { kAscii, kBinaryLittleEndian, kBinaryBigEndian };

struct PlyProperty {
  std::string name;
  ScalarType type = ScalarType::kFloat32;
  std::optional<ScalarType> list_count;  ///< type of a list's length; absent: a scalar
};

struct PlyElement {
  std::string name;
  std::int64_t count = 0;  ///< as the header claims; to be checked against the size of the file
  int line = 0;            ///< of its declaration, from 1
  std::vector<PlyProperty> properties;

  /// Index of the property with that name.
  std::optional<std::size_t> find(std::string_view property) const;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::kAscii;
  std::vector<PlyElement> elements;
  std::vector<std::string> comments;  ///< their text, without surrounding blanks
  std::size_t num_bytes = 0;          ///< offset at which the data begin
  int num_lines = 0;
};

/// Reads the header at the beginning of `bytes`; lines may end in LF or CRLF.
///
/// @param path only names the file in errors
/// @throws std::runtime_error with file, line, what was found and what was expected: a file that is
///   not PLY, no end_header, an unknown format, keyword or type, a count that is not a number, a
///   duplicate element or property, a list without its types
PlyHeader parse_ply_header(std::string_view bytes, const std::string& path);

}  // namespace kintsugi::segmenter
