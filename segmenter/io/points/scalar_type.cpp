#include "segmenter/io/points/scalar_type.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <limits>
#include <type_traits>

namespace kintsugi::segmenter {
namespace {

struct TypeInfo {
  ScalarType type;
  std::size_t size;
  std::string_view name;
  std::string_view other_name;
};

// In the order of ScalarType.
constexpr std::array<TypeInfo, 8> kTypes{{
    {ScalarType::kInt8, 1, "char", "int8"},
    {ScalarType::kUint8, 1, "uchar", "uint8"},
    {ScalarType::kInt16, 2, "short", "int16"},
    {ScalarType::kUint16, 2, "ushort", "uint16"},
    {ScalarType::kInt32, 4, "int", "int32"},
    {ScalarType::kUint32, 4, "uint", "uint32"},
    {ScalarType::kFloat32, 4, "float", "float32"},
    {ScalarType::kFloat64, 8, "double", "float64"},
}};

const TypeInfo& info(ScalarType type) { return kTypes.at(static_cast<std::size_t>(type)); }

/// Calls `function` with a value of the C++ type that `type` stands for.
template <class Function>
auto with_type(ScalarType type, const Function& function) {
  switch (type) {
    case ScalarType::kInt8:
      return function(std::int8_t{});
    case ScalarType::kUint8:
      return function(std::uint8_t{});
    case ScalarType::kInt16:
      return function(std::int16_t{});
    case ScalarType::kUint16:
      return function(std::uint16_t{});
    case ScalarType::kInt32:
      return function(std::int32_t{});
    case ScalarType::kUint32:
      return function(std::uint32_t{});
    case ScalarType::kFloat32:
      return function(float{});
    case ScalarType::kFloat64:
      break;
  }
  return function(double{});
}

template <class T>
T nearest(double value) {
  if constexpr (std::is_same_v<T, double>) {
    return value;
  } else if constexpr (std::is_same_v<T, float>) {
    return to_float(value);
  } else {
    if (std::isnan(value)) return 0;
    return static_cast<T>(std::clamp(std::round(value),
                                     static_cast<double>(std::numeric_limits<T>::min()),
                                     static_cast<double>(std::numeric_limits<T>::max())));
  }
}

}  // namespace

std::size_t size_of(ScalarType type) { return info(type).size; }

bool is_integer(ScalarType type) {
  return type != ScalarType::kFloat32 && type != ScalarType::kFloat64;
}

std::string_view name_of(ScalarType type) { return info(type).name; }

std::optional<ScalarType> scalar_type_of(std::string_view name) {
  for (const TypeInfo& candidate : kTypes) {
    if (name == candidate.name || name == candidate.other_name) return candidate.type;
  }
  return std::nullopt;
}

double read_scalar(const char* bytes, ScalarType type, bool swap) {
  return with_type(type, [&](auto value) {
    std::array<char, sizeof value> buffer;
    std::copy_n(bytes, sizeof value, buffer.begin());
    if (swap) std::reverse(buffer.begin(), buffer.end());
    std::memcpy(&value, buffer.data(), sizeof value);
    return static_cast<double>(value);
  });
}

void write_scalar(double value, ScalarType type, char* bytes) {
  with_type(type, [&](auto zero) {
    const auto typed = nearest<decltype(zero)>(value);
    std::memcpy(bytes, &typed, sizeof typed);
  });
}

bool holds(ScalarType type, double value) {
  return with_type(type, [&](auto zero) {
    return !std::is_integral_v<decltype(zero)> ||
           static_cast<double>(nearest<decltype(zero)>(value)) == value;
  });
}

float to_float(double value) {
  constexpr double kMax = std::numeric_limits<float>::max();
  if (std::abs(value) > kMax) {
    return value > 0.0 ? std::numeric_limits<float>::infinity()
                       : -std::numeric_limits<float>::infinity();
  }
  return static_cast<float>(value);
}

}  // namespace kintsugi::segmenter
