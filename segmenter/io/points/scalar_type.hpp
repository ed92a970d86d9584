#pragma once
// The types of numbers in point cloud files, by the names that PLY gives them.

#include <cstddef>
#include <optional>
#include <string_view>

namespace kintsugi::segmenter {

/// double holds every value of each of them exactly.
enum class ScalarType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

std::size_t size_of(ScalarType type);  ///< bytes in a binary file
bool is_integer(ScalarType type);
std::string_view name_of(ScalarType type);  ///< "uchar", "float", ...

/// The type called "uchar" or "uint8", "float" or "float32", ...; nothing for other words.
std::optional<ScalarType> scalar_type_of(std::string_view name);

/// The number at `bytes`, which need not be aligned.
/// @param swap whether its byte order is not this machine's
double read_scalar(const char* bytes, ScalarType type, bool swap = false);

/// Writes `value` in this machine's byte order. Integers are rounded, values beyond the type become
/// its nearest, and NaN becomes 0.
void write_scalar(double value, ScalarType type, char* bytes);

/// Whether a value of this type can be written without a change: always for real types, which only
/// lose digits.
bool holds(ScalarType type, double value);

/// The float nearest to `value`; beyond its range infinity.
float to_float(double value);

}  // namespace kintsugi::segmenter
