#include "mapper/source/openni2/openni2_source.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include "lcmtypes/base/stopwatch.hpp"
#include "mapper/source/openni2/openni2_opening.hpp"

namespace kintsugi::mapper {
namespace {

constexpr auto kPoll = std::chrono::milliseconds(100);
// A disk on the network, or a machine that is busy with other things, may take long for an image.
constexpr double kMaxSilenceOfRecording_s = 60.0;
// A second of a camera: longer than one takes to start.
constexpr std::int64_t kImagesWithoutDepth = 30;

std::int64_t depth_period_us(const OpenNi2Device& device) {
  return 1'000'000 / device.depth_rate_hz();
}

std::string in_seconds(double seconds) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f s", seconds);
  return text.data();
}

std::string in_metres(double metres) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g m", metres);
  return text.data();
}

}  // namespace

OpenNi2Source::OpenNi2Source(const SourceConfig& config)
    : config_(config),
      device_(open_device(config, damage_)),
      clock_(!device_->is_recording(), depth_period_us(*device_)),
      color_clock_(depth_period_us(*device_)),
      pairer_(device_->has_color(), depth_period_us(*device_)),
      last_depth_s_(patience_.now_s()) {
  const Intrinsics intrinsics = find_intrinsics(config, *device_);
  converter_.emplace(intrinsics, device_->depth_units_per_m(), config.max_range_m);
  status_.name = device_->name();
  status_.frames_total = device_->num_depth_frames().value_or(-1);
  tell_how_it_is_read(intrinsics.fy < 0.0);
}

void OpenNi2Source::tell_how_it_is_read(bool y_points_up) {
  const std::string remark = device_->remark();
  if (!remark.empty()) config_.notify({SourceNotice::Kind::kInformation, remark});
  if (!y_points_up) return;
  config_.notify({SourceNotice::Kind::kInformation,
                  "fy < 0: the camera's y axis points up, so the rows of the images are reversed"});
}

std::optional<RgbdFrame> OpenNi2Source::next() {
  for (;;) {
    if (const auto raw = pairer_.take()) {
      ++status_.counts.frames_delivered;
      const Stopwatch stopwatch;
      RgbdFrame frame = converter_->convert(*raw);
      status_.counts.convert_ms += stopwatch.elapsed_ms();
      look_for_depth(frame);
      return frame;
    }
    if (!status_.end_reason.empty()) {
      warn_of_no_depth();
      return std::nullopt;
    }
    if (config_.stop_requested()) {
      end(true, "stopped on request");
    } else if (device_) {
      read_image();
    } else {
      wait_for_camera();
    }
  }
}

void OpenNi2Source::look_for_depth(const RgbdFrame& frame) {
  if (!looks_for_depth_) return;
  if (std::ranges::any_of(frame.depth_m, [](float z_m) { return z_m > 0.0F; })) {
    looks_for_depth_ = false;
  } else if (status_.counts.frames_delivered == kImagesWithoutDepth) {
    warn_of_no_depth();
  }
}

/// Once, unless there was some.
void OpenNi2Source::warn_of_no_depth() {
  if (!looks_for_depth_ || status_.counts.frames_delivered == 0) return;
  looks_for_depth_ = false;
  config_.notify({SourceNotice::Kind::kWarning,
                  "the first " + std::to_string(status_.counts.frames_delivered) +
                      " depth images have no depth within 0 to " + in_metres(config_.max_range_m) +
                      " (--max-range): is the camera covered, or depth_scale wrong?"});
}

SourceStatus OpenNi2Source::status() const {
  SourceStatus status = status_;
  status.counts.depth_unpaired = pairer_.depth_unpaired();
  status.counts.color_unpaired = pairer_.color_unpaired();
  status.counts.frames_bad += unread_.total();
  return status;
}

void OpenNi2Source::read_image() {
  const DeviceState state_before = device_->state();
  try {
    auto image = device_->wait(kPoll);
    count_unread();
    if (image) {
      add(std::move(*image));
    } else {
      check_for_end(state_before);
    }
  } catch (const std::runtime_error& refusal) {
    ++status_.counts.frames_bad;
    last_refusal_ = refusal.what();
  }
  if (device_) check_for_silence();
}

void OpenNi2Source::count_unread() {
  if (const auto said = unread_.update(device_->unread_images())) {
    config_.notify({SourceNotice::Kind::kWarning, *said});
  }
}

void OpenNi2Source::add(DeviceImage image) {
  // Exposure is the colour camera's, whose clock may be another one than that of depth.
  if (!image.is_depth || !device_->has_color()) lock_exposure_when_due(image.utime);
  const auto stream = image.is_depth ? DeviceClock::Stream::kDepth : DeviceClock::Stream::kColor;
  const std::int64_t utime = clock_.time_of(stream, image.utime, Clock::now());
  if (!image.is_depth) {
    return pairer_.add_color(color_clock_.add_color(utime), std::move(image.color_rgb));
  }
  last_depth_s_ = patience_.now_s();
  compare_clocks(utime);
  pairer_.add_depth(utime, continuous_index(image.index), std::move(image.depth_raw));
}

void OpenNi2Source::compare_clocks(std::int64_t depth_utime) {
  const std::int64_t known_us = color_clock_.ahead_us();
  color_clock_.add_depth(depth_utime);
  if (color_clock_.ahead_us() == known_us) return;
  config_.notify({SourceNotice::Kind::kInformation,
                  "the clock of the colour images is ahead of that of the depth images by " +
                      in_seconds(1e-6 * static_cast<double>(color_clock_.ahead_us())) +
                      ": taken into account"});
}

/// Continues the count when the device starts again from 0. Images that were left out count as
/// dropped, except those that cannot be read.
std::int64_t OpenNi2Source::continuous_index(std::int64_t index) {
  const std::int64_t step = device_index_ && index > *device_index_ ? index - *device_index_ : 1;
  device_index_ = index;
  status_.counts.frames_dropped += step - 1 - unread_.explain_gap(step - 1);
  frame_index_ = frame_index_ ? *frame_index_ + step : index;
  return *frame_index_;
}

void OpenNi2Source::lock_exposure_when_due(std::int64_t stamp_us) {
  if (!config_.lock_exposure_after_s || exposure_locked_) return;
  if (!first_stamp_us_) first_stamp_us_ = stamp_us;
  const double elapsed_s = 1e-6 * static_cast<double>(stamp_us - *first_stamp_us_);
  if (elapsed_s < *config_.lock_exposure_after_s) return;
  exposure_locked_ = true;
  if (device_->lock_exposure()) return;
  config_.notify({SourceNotice::Kind::kWarning,
                  "exposure cannot be locked: the device has no such camera settings"});
}

/// Called when no image arrived. For recordings, OpenNI2 times out only after the last image.
/// @param state_before state before the wait: images that were played by then have been read
void OpenNi2Source::check_for_end(DeviceState state_before) {
  switch (state_before) {
    case DeviceState::kPlaying:
      return;
    case DeviceState::kEnded:
      if (!damage_.empty()) return end(false, "ended after " + damage_);
      if (!device_index_ && !last_refusal_.empty()) {
        return end(false, "no depth image can be used, the last was refused: " + last_refusal_);
      }
      return end(true, "end of the recording");
    case DeviceState::kFailed:
      if (device_->is_recording()) return end(false, device_->failure());
      return interrupt(device_->failure());
    case DeviceState::kGone:
      return interrupt("it was disconnected");
  }
}

void OpenNi2Source::check_for_silence() {
  const double silence_s = patience_.now_s() - last_depth_s_;
  const bool is_recording = device_->is_recording();
  if (silence_s < (is_recording ? kMaxSilenceOfRecording_s : config_.device_silence_s)) return;
  std::string reason = "no depth image came for " + in_seconds(silence_s);
  if (!last_refusal_.empty()) reason += ", the last image was refused: " + last_refusal_;
  if (is_recording) return end(false, reason);
  interrupt(reason);
}

void OpenNi2Source::interrupt(const std::string& reason) {
  ++status_.counts.interruptions;
  config_.notify({SourceNotice::Kind::kInterrupted,
                  "device '" + status_.name + "' is gone: " + reason + "; waiting for it"});
  return_.emplace(config_, *device_);
  device_.reset();
  unread_.device_closed();
  pairer_.finish();
  clock_.interrupt();
}

void OpenNi2Source::wait_for_camera() {
  device_ = return_->wait(kPoll);
  const double away_s = return_->seconds_away();
  if (!device_) {
    if (config_.reconnect_s == 0.0 || away_s < config_.reconnect_s) return;
    return end(false, "device '" + status_.name + "' did not come back in " + in_seconds(away_s) +
                          ": " + return_->last_error());
  }
  return_.reset();
  pairer_.resume(device_->has_color());
  device_index_.reset();
  first_stamp_us_.reset();
  exposure_locked_ = false;
  last_refusal_.clear();
  last_depth_s_ = patience_.now_s();
  config_.notify({SourceNotice::Kind::kResumed,
                  "device '" + status_.name + "' is back after " + in_seconds(away_s)});
}

void OpenNi2Source::end(bool well, const std::string& reason) {
  status_.ended_well = well;
  status_.end_reason = reason;
  if (unread_.total() > 0) config_.notify({SourceNotice::Kind::kWarning, unread_.summary()});
  if (device_) device_->stop();
  pairer_.finish();
}

}  // namespace kintsugi::mapper
