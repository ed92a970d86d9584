#pragma once

#include "mapper/core/stage_times.hpp"

namespace kintsugi::mapper {

/// Times of one frame, milliseconds.
struct FrameTimings {
  double read_ms = 0.0;     ///< wall, including waiting for the device; parallel to the stages
  double convert_ms = 0.0;  ///< CPU of the reading thread: conversion, undistortion
  StageTimes stages;        ///< wall
  double extract_ms = 0.0;  ///< wall, of the slices since the last frame; parallel to the stages
  double publish_ms = 0.0;  ///< wall
  double frame_ms = 0.0;    ///< wall, from taking the frame to sending its messages
  double cpu_ms = 0.0;      ///< of all threads of the process since the last frame

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
