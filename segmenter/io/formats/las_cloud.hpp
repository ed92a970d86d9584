#pragma once
// Reads points from LAS files (ASPRS LAS 1.0 to 1.4).

#include <string>
#include <string_view>

#include "segmenter/io/points/point_table.hpp"

namespace kintsugi::segmenter {

/// Reads the uncompressed point formats 0 to 10: x y z (double, with scale and offset), intensity,
/// the bytes of flags, classification, scan_angle, user_data, point_source_id, and by format
/// gps_time, red green blue (uchar; 16 bits are cut to 8 unless all are below 256) and nir.
/// Waveforms and extra bytes are left out.
///
/// @param bytes of the file; `name` stands for it in errors
/// @throws std::runtime_error naming the file, the byte and what was expected: a bad header, more
///   points than the file holds, or compressed points (LAZ), which cannot be read
PointTable parse_las_cloud(std::string_view bytes, const std::string& name);

}  // namespace kintsugi::segmenter
