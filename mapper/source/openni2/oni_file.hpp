#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

namespace kintsugi::mapper {

/// The content of a .oni file by its records, whatever its header announces.
///
/// OpenNI2's file driver refuses truncated files without a reason, because it reads the seek tables
/// at the end first, and would announce frames that are missing.
struct OniFile {
  struct Node {
    enum class Kind { kDepth, kColor, kOther };
    Kind kind = Kind::kOther;
    std::uint64_t fields_position = 0;  ///< of its number of frames, in the file
    std::uint32_t frames_announced = 0;
    int frames = 0;  ///< that are complete
  };

  std::map<std::uint32_t, Node> nodes;  ///< by id
  std::uint64_t good_bytes = 0;         ///< up to the end of the last complete record
  std::string damage;                   ///< what is wrong, and where; empty: nothing
  bool can_be_mended = true;            ///< its version is at least 1.0.1

  [[nodiscard]] int frames(Node::Kind kind) const;
  /// As announced when the recording was finished; 0 when it was not finished.
  [[nodiscard]] std::uint32_t frames_announced(Node::Kind kind) const;
};

/// Whether the file begins like one. One that is too short to tell, or is not there, is by its
/// name.
bool is_oni_file(const std::filesystem::path& file);

/// Walks through the records of a .oni file (NI10, versions 1.0.0.4 to 1.0.1.0).
/// @throws std::runtime_error naming the file and what was expected, when it is missing, empty, not
///   a .oni file, of an unknown version, or without a depth image
OniFile scan_oni_file(const std::filesystem::path& file);

/// Writes a copy of a damaged file that OpenNI2 can read up to the damage: complete records only,
/// the correct number of frames, no seek tables, an end record.
/// @throws std::runtime_error when it cannot be written, or the version of `file` is before 1.0.1
void write_mended_copy(const std::filesystem::path& file, const OniFile& contents,
                       const std::filesystem::path& copy);

}  // namespace kintsugi::mapper
