#pragma once
// Reads points from NumPy's files.

#include <string>
#include <string_view>

#include "segmenter/io/points/point_table.hpp"

namespace kintsugi::segmenter {

/// Reads an array of float32, float64 or integers whose last dimension has the columns of a point,
/// at least x y z: N x 3, N x 6, or H x W x 3. C or Fortran order (two dimensions), either byte
/// order. What the columns are is guessed (guess_column_names()); float64 and integers become
/// double, except colours.
///
/// @param bytes of the file; `name` stands for it in errors
/// @throws std::runtime_error naming the file, what is wrong and what was expected: a bad header,
///   another type or shape, more or fewer bytes than the shape takes
PointTable parse_npy_cloud(std::string_view bytes, const std::string& name);

}  // namespace kintsugi::segmenter
