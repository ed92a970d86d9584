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

#include "mapper/source/frame_source.hpp"

namespace kintsugi::mapper {

/// A frame and what reading it took, milliseconds.
struct TimedFrame {
  RgbdFrame frame;
  double read_ms = 0.0;     ///< wall, waiting for the device included
  double convert_ms = 0.0;  ///< CPU of the reading thread: conversion, undistortion
};

/// Reads one frame ahead on a thread of its own: the next frame is decoded while this one is
/// mapped.
class FrameReader {
 public:
  using Attach = std::function<std::unique_ptr<FrameSource>(std::unique_ptr<FrameSource>)>;

  /// Opens the source, and reads from what `attach` (may be empty) makes of it.
  /// @throws as open_frame_source() and `attach`
  explicit FrameReader(SourceConfig config, const Attach& attach = {});
  /// Reads from a source that is open already; `config.stop_requested` cannot reach it.
  explicit FrameReader(std::unique_ptr<FrameSource> source);
  ~FrameReader();
  FrameReader(const FrameReader&) = delete;
  FrameReader& operator=(const FrameReader&) = delete;

  /// The next frame if it comes within `timeout`.
  std::optional<TimedFrame> next(std::chrono::milliseconds timeout);

  /// No frame will come any more.
  bool finished() const;

  /// Throws what reading threw, if it did.
  void rethrow_failure() const;

  /// The camera is gone and waited for.
  bool interrupted() const { return interrupted_; }

  const std::string& device_name() const { return name_; }
  std::int64_t frames_total() const { return frames_total_; }
  SourceCounts counts() const;
  /// Of the source, once finished().
  std::string end_reason() const;
  bool ended_well() const;

 private:
  void run();
  std::optional<TimedFrame> read();

  std::atomic<bool> stop_ = false;
  std::atomic<bool> interrupted_ = false;
  std::unique_ptr<FrameSource> source_;
  std::string name_;
  std::int64_t frames_total_ = -1;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<TimedFrame> frame_;
  bool ended_ = false;
  bool ended_well_ = true;
  std::string end_reason_;
  std::exception_ptr failure_;
  SourceCounts counts_;
  std::thread thread_;
};

}  // namespace kintsugi::mapper
