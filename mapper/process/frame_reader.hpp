#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
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
  double read_ms = 0.0;         ///< wall time, including waiting for the device
  double convert_ms = 0.0;      ///< CPU time of the reading thread: conversion, undistortion
  std::size_t num_waiting = 0;  ///< frames that were read after it, when it was taken
};

/// Reads frames in its own thread, ahead of who maps them: the next frame is decoded meanwhile, and
/// those of a live source can wait for a while before the source has to drop some.
class FrameReader {
 public:
  using Attach = std::function<std::unique_ptr<FrameSource>(std::unique_ptr<FrameSource>)>;

  /// Opens the source and reads from what `attach` returns for it; without `attach`, from itself.
  /// @param max_waiting frames that are read ahead, at least 1
  /// @throws as open_frame_source() and `attach`
  explicit FrameReader(SourceConfig config, const Attach& attach = {}, std::size_t max_waiting = 1);
  /// Reads from a source that is open already. The destructor waits for its next() to return.
  explicit FrameReader(std::unique_ptr<FrameSource> source, std::size_t max_waiting = 1);
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

  const std::size_t max_waiting_;
  std::atomic<bool> stop_ = false;
  std::atomic<bool> interrupted_ = false;
  std::unique_ptr<FrameSource> source_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<TimedFrame> frames_;
  bool ended_ = false;
  std::exception_ptr failure_;
  SourceStatus status_;
  std::thread thread_;
};

}  // namespace kintsugi::mapper
