#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <thread>

#include "mapper/source/frames/frame_source.hpp"

namespace kintsugi::mapper::testing {

inline constexpr std::int64_t kPeriod_us = 10'000;

/// A recording of empty frames: frame i has time i * kPeriod_us. Each takes `effort` to read.
class EmptyRecording : public FrameSource {
 public:
  explicit EmptyRecording(int count, std::chrono::milliseconds effort = {})
      : count_(count), effort_(effort) {}
  std::optional<RgbdFrame> next() override {
    if (given_ == count_) return std::nullopt;
    if (effort_.count() > 0) std::this_thread::sleep_for(effort_);
    RgbdFrame frame;
    frame.frame_index = given_;
    frame.utime = kPeriod_us * given_++;
    return frame;
  }
  SourceStatus status() const override {
    return {.name = "recording",
            .frames_total = count_,
            .counts = {.frames_delivered = given_},
            .end_reason = given_ == count_ ? "all given" : ""};
  }

 private:
  int count_;
  std::chrono::milliseconds effort_;
  int given_ = 0;
};

}  // namespace kintsugi::mapper::testing
