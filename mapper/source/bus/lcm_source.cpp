#include "mapper/source/bus/lcm_source.hpp"

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "lcmtypes/base/patient_clock.hpp"
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
  while (const auto message = wait_for_message()) {
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

std::optional<RgbdFrameMessage> LcmSource::wait_for_message() {
  PatientClock patience;
  while (status_.end_reason.empty()) {
    if (auto message = receiver_->pop(kPoll)) return message;
    const bool silent =
        session_ != 0 && config_.lcm_silence_s > 0.0 && patience.now_s() > config_.lcm_silence_s;
    if (config_.stop_requested()) {
      end(true, "stopped on request");
    } else if (receiver_->thread->failed()) {
      // LCM reads a log like a bus, and its end is the end of the connection.
      const bool is_log = config_.lcm_url.starts_with("file:");
      end(is_log, is_log ? "end of the log" : "the connection to the bus failed");
    } else if (silent) {
      end(true, "nothing came on " + config_.device + " for " +
                    std::to_string(config_.lcm_silence_s) + " s");
    }
  }
  return std::nullopt;
}

/// nullopt for a frame that is refused.
std::optional<RgbdFrame> LcmSource::convert(const RgbdFrameMessage& message) {
  if (session_ == 0) session_ = message.session;
  const bool next_in_session = message.session == session_ && message.utime > last_utime_;
  try {
    if (!next_in_session) throw std::runtime_error("another session, or out of order");
    const Stopwatch stopwatch;
    RgbdFrame frame = decoder_->decode(message);
    status_.counts.convert_ms += stopwatch.elapsed_ms();
    last_utime_ = message.utime;
    ++status_.counts.frames_delivered;
    if (frame.color_rgb.empty()) ++status_.counts.depth_unpaired;
    return frame;
  } catch (const std::exception&) {
    ++status_.counts.frames_bad;
    return std::nullopt;
  }
}

void LcmSource::end(bool well, const std::string& reason) {
  status_.ended_well = well;
  status_.end_reason = reason;
}

}  // namespace kintsugi::mapper
