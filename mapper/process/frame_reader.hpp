#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "mapper/source/frames/frame_source.hpp"
#include "mapper/source/frames/source_config.hpp"

namespace kintsugi::mapper {

/// A frame and how long reading it took, milliseconds.
struct TimedFrame {
  RgbdFrame frame;
  double read_ms = 0.0;     ///< wall time, including waiting for the device
  double convert_ms = 0.0;  ///< CPU time of the reading thread: conversion, undistortion
};

/// Reads frames in its own thread, one ahead: the next frame is decoded while this one is mapped.
class FrameReader {
 public:
  using Attach = std::function<std::unique_ptr<FrameSource>(std::unique_ptr<FrameSource>)>;

  /// Opens the source and reads from what `attach` returns for it; without `attach`, from itself.
  /// @throws as open_frame_source() and `attach`
  explicit FrameReader(SourceConfig config, const Attach& attach = {});
  /// Reads from a source that is open already. The destructor waits for its next() to return.
  explicit FrameReader(std::unique_ptr<FrameSource> source);
  ~FrameReader();
  FrameReader(const FrameReader&) = delete;
  FrameReader& operator=(const FrameReader&) = delete;

  /// The next frame if it comes within `timeout`.
  std::optional<TimedFrame> next(std::chrono::milliseconds timeout);

  /// True when next() will return no more frames.
  bool finished() const;

  /// Throws the exception that ended reading, if there was one.
  void rethrow_failure() const;

  /// True while the camera is disconnected and waited for.
  bool interrupted() const { return interrupted_; }

  /// Of the source, after the frame that was read last. After an exception ended_well is false.
  SourceStatus status() const;

 private:
  void run();
  std::optional<TimedFrame> read();

  std::atomic<bool> stop_ = false;
  std::atomic<bool> interrupted_ = false;
  std::unique_ptr<FrameSource> source_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<TimedFrame> frame_;
  bool ended_ = false;
  std::exception_ptr failure_;
  SourceStatus status_;
  std::thread thread_;
};

}  // namespace kintsugi::mapper
