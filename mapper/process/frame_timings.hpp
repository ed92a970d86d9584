#pragma once

#include "mapper/core/stage_times.hpp"

namespace kintsugi::mapper {

/// What one frame cost, milliseconds.
struct FrameTimings {
  double read_ms = 0.0;     ///< wall, waiting for the device included; while others work
  double convert_ms = 0.0;  ///< CPU of the reading thread: conversion, undistortion
  StageTimes stages;        ///< wall
  double extract_ms = 0.0;  ///< wall, of slices since the frame before; while others work
  double publish_ms = 0.0;  ///< wall
  double frame_ms = 0.0;    ///< wall, from the frame taken to its messages sent
  double cpu_ms = 0.0;      ///< of all threads of the process since the frame before

  FrameTimings& operator+=(const FrameTimings& other) {
    read_ms += other.read_ms;
    convert_ms += other.convert_ms;
    stages += other.stages;
    extract_ms += other.extract_ms;
    publish_ms += other.publish_ms;
    frame_ms += other.frame_ms;
    cpu_ms += other.cpu_ms;
    return *this;
  }
};

}  // namespace kintsugi::mapper
