#pragma once
// Typed values behind OpenNI2's untyped property calls.

#include <algorithm>
#include <cstring>
#include <string>

#include "mapper/openni2_driver/plugin/oni_driver_api.hpp"

namespace kintsugi::mapper {

template <typename T>
OniStatus give_property(const T& value, void* data, int* size) {
  if (data == nullptr || *size < static_cast<int>(sizeof(T))) return ONI_STATUS_BAD_PARAMETER;
  std::memcpy(data, &value, sizeof(T));
  *size = sizeof(T);
  return ONI_STATUS_OK;
}

/// Zero-terminated, truncated to what fits.
inline OniStatus give_text(const std::string& text, void* data, int* size) {
  if (data == nullptr || *size < 1) return ONI_STATUS_BAD_PARAMETER;
  const std::size_t length = std::min(text.size(), static_cast<std::size_t>(*size) - 1);
  std::memcpy(data, text.data(), length);
  static_cast<char*>(data)[length] = '\0';
  *size = static_cast<int>(length) + 1;
  return ONI_STATUS_OK;
}

template <typename T>
OniStatus take_property(const void* data, int size, T& value) {
  if (data == nullptr || size != static_cast<int>(sizeof(T))) return ONI_STATUS_BAD_PARAMETER;
  std::memcpy(&value, data, sizeof(T));
  return ONI_STATUS_OK;
}

}  // namespace kintsugi::mapper
