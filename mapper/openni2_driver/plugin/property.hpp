#pragma once
// Typed values behind OpenNI2's untyped property calls.

#include <cstring>

#include "mapper/openni2_driver/plugin/oni_driver_api.hpp"

namespace kintsugi::mapper {

template <typename T>
OniStatus give_property(const T& value, void* data, int* size) {
  if (data == nullptr || *size < static_cast<int>(sizeof(T))) return ONI_STATUS_BAD_PARAMETER;
  std::memcpy(data, &value, sizeof(T));
  *size = sizeof(T);
  return ONI_STATUS_OK;
}

template <typename T>
OniStatus take_property(const void* data, int size, T& value) {
  if (data == nullptr || size != static_cast<int>(sizeof(T))) return ONI_STATUS_BAD_PARAMETER;
  std::memcpy(&value, data, sizeof(T));
  return ONI_STATUS_OK;
}

}  // namespace kintsugi::mapper
