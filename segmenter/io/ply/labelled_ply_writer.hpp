#pragma once
// Writes labelled clouds as PLY files.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "lcmtypes/base/ply_writer.hpp"
#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

/// A segment id as PLY files have it: int, as Open3D passes over uint.
/// @throws std::overflow_error for ids from 2^31 on
std::int32_t signed_label(std::uint32_t segment_id);

/// Writes a binary little-endian PLY with the vertex properties
///   float x y z nx ny nz, uchar red green blue, int segment_id, int slice_id, float weight,
///   uchar in_volume (1: of a patch that may still change)
/// in that order. Positions and normals are exactly those that were segmented, so that anyone can
/// check the labels. The complete file appears under its name at commit().
class LabelledPlyWriter {
 public:
  /// @param num_points exactly as many as will be appended
  /// @param comments lines for the header, without line ends
  /// @throws std::system_error naming the file and the reason, as do append() and commit()
  LabelledPlyWriter(const std::filesystem::path& path, std::int64_t num_points,
                    const std::vector<std::string>& comments);

  void append(const CloudPoint& point_W, std::uint32_t segment_id, std::int32_t slice_id,
              bool is_in_volume = false);

  /// @throws std::logic_error when the number of points is not what the header says
  void commit() { writer_.commit(); }

 private:
  PlyWriter writer_;
};

}  // namespace kintsugi::segmenter
