#include "mapper/source/bus/lcm_source.hpp"

#include <chrono>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "lcmtypes/base/stopwatch.hpp"
#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/bus/bus_thread.hpp"
#include "lcmtypes/stream/stream_subscriber.hpp"
#include "mapper/openni2_driver/formats/calibration.hpp"
#include "mapper/source/bus/rgbd_frame_decoder.hpp"

namespace kintsugi::mapper {
namespace {

constexpr auto kPoll = std::chrono::milliseconds(100);
constexpr std::size_t kMaxWaitingInReplay = 8192;  // about 2 GB of compressed frames

std::string channel_of(const std::string& device) {
  std::string channel = device.substr(kLcmScheme.size());
  if (channel.empty()) {
    throw std::invalid_argument("device '" + device + "' names no channel, expected lcm://CHANNEL");
  }
  return channel;
}

}  // namespace

/// Puts messages from the bus into a queue, in its own thread.
struct LcmSource::Receiver {
  Receiver(const std::string& channel, const SourceConfig& config)
      : max_waiting(config.replay ? kMaxWaitingInReplay : 1),
        bus(config.lcm_url),
        subscriber(channel, [this](RgbdFrameMessage message) { push(std::move(message)); }) {
    subscriber.subscribe(bus);
    thread.emplace(bus);
  }

  void push(RgbdFrameMessage message) {
    {
      const std::lock_guard lock(mutex);
      queue.push_back(std::move(message));
      if (queue.size() > max_waiting) {
        queue.pop_front();
        ++dropped;
      }
    }
    arrived.notify_one();
  }

  std::optional<RgbdFrameMessage> pop(std::chrono::milliseconds timeout) {
    std::unique_lock lock(mutex);
    if (!arrived.wait_for(lock, timeout, [this] { return !queue.empty(); })) return std::nullopt;
    RgbdFrameMessage message = std::move(queue.front());
    queue.pop_front();
    return message;
  }

  const std::size_t max_waiting;
  std::mutex mutex;  ///< guards the next three
  std::condition_variable arrived;
  std::deque<RgbdFrameMessage> queue;
  std::int64_t dropped = 0;
  Bus bus;
  StreamSubscriber<RgbdFrameMessage> subscriber;
  std::optional<BusThread> thread;  ///< last: stops before the members that it uses are destroyed
};

LcmSource::LcmSource(const SourceConfig& config) : config_(config) {
  std::optional<Intrinsics> calibration;
  if (!config.calibration_file.empty()) {
    calibration = read_calibration(config.calibration_file).intrinsics;
  }
  decoder_ = std::make_unique<RgbdFrameDecoder>(config.max_range_m, calibration);
  status_.name = config.device;
  receiver_ = std::make_unique<Receiver>(channel_of(config.device), config);
}

LcmSource::~LcmSource() = default;

std::optional<RgbdFrame> LcmSource::next() {
  PatientClock patience;
  while (const auto message = wait_for_message(patience)) {
    if (auto frame = convert(*message)) return frame;
  }
  return std::nullopt;
}

SourceStatus LcmSource::status() const {
  SourceStatus status = status_;
  const std::lock_guard lock(receiver_->mutex);
  const StreamCounts counts = receiver_->subscriber.counts();
  status.counts.frames_dropped += receiver_->dropped;
  status.counts.frames_bad += counts.messages_bad + counts.messages_given_up;
  return status;
}

/// @param patience since when no frame was good
std::optional<RgbdFrameMessage> LcmSource::wait_for_message(PatientClock& patience) {
  while (status_.end_reason.empty()) {
    // The sender has ended, or all that comes is refused, as of one that began anew.
    const bool is_silent =
        session_ != 0 && config_.lcm_silence_s > 0.0 && patience.now_s() > config_.lcm_silence_s;
    if (is_silent) {
      end(true, "no frame that can be used came on " + config_.device + " for " +
                    std::to_string(std::lround(config_.lcm_silence_s)) + " s");
    } else if (auto message = receiver_->pop(kPoll)) {
      return message;
    } else if (config_.stop_requested()) {
      end(true, "stopped on request");
    } else if (receiver_->thread->failed()) {
      // LCM reads a log like a bus, and its end is the end of the connection.
      const bool is_log = receiver_->bus.url().starts_with("file:");
      end(is_log, is_log ? "end of the log" : "the connection to the bus failed");
    }
  }
  return std::nullopt;
}

/// nullopt for a frame that is refused.
std::optional<RgbdFrame> LcmSource::convert(const RgbdFrameMessage& message) {
  if (session_ == 0) session_ = message.session;
  try {
    if (message.session != session_) {
      throw std::runtime_error("it is of session " + std::to_string(message.session) +
                               ", the frames before are of " + std::to_string(session_));
    }
    if (message.utime <= last_utime_) {
      throw std::runtime_error("its time, " + std::to_string(message.utime) +
                               " us, is not after that of the frame before, " +
                               std::to_string(last_utime_) + " us");
    }
    const Stopwatch stopwatch;
    RgbdFrame frame = decoder_->decode(message);
    status_.counts.convert_ms += stopwatch.elapsed_ms();
    last_utime_ = message.utime;
    ++status_.counts.frames_delivered;
    if (frame.color_rgb.empty()) ++status_.counts.depth_unpaired;
    return frame;
  } catch (const std::exception& error) {
    if (status_.counts.frames_bad++ == 0) {
      config_.notify({SourceNotice::Kind::kWarning, "a frame on " + config_.device +
                                                        " is refused: " + error.what() +
                                                        "; further ones are only counted, as bad"});
    }
    return std::nullopt;
  }
}

void LcmSource::end(bool well, const std::string& reason) {
  status_.ended_well = well;
  status_.end_reason = reason;
}

}  // namespace kintsugi::mapper
