#include "viewer/process/run.hpp"

#include <bit>
#include <chrono>
#include <filesystem>
#include <optional>
#include <thread>
#include <utility>

#include "lcmtypes/base/logger.hpp"
#include "lcmtypes/base/patient_clock.hpp"
#include "lcmtypes/base/stop_signal.hpp"
#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/bus/bus_thread.hpp"
#include "lcmtypes/log/whole_log_reader.hpp"
#include "viewer/process/viewer_publisher.hpp"
#include "viewer/receiving/inbox.hpp"
#include "viewer/receiving/receiver.hpp"

namespace kintsugi::viewer {
namespace {

/// Logs the 1st, 2nd, 4th, 8th, ... bad message, because there may be very many.
void report_bad(std::int64_t count, const std::string& reason) {
  if (std::has_single_bit(static_cast<std::uint64_t>(count))) {
    spdlog::warn("dropped bad message {}: {}", count, reason);
  }
}

/// The viewer on the bus: one thread receives, the caller's thread draws.
class RunOnBus {
 public:
  explicit RunOnBus(const Options& options)
      : options_(options),
        bus_(options.lcm_url),
        publisher_(bus_),
        inbox_(options.max_queue_bytes()),
        receiver_(
            {.map_name = options.map_name,
             .receiver = publisher_.session(),
             .max_request_bytes = bus_.max_message_bytes(),
             .has_room = [this] { return inbox_.has_room(); },
             .max_pending_bytes = options.max_queue_bytes()},
            [this](Message message) { inbox_.put(std::move(message)); }, report_bad),
        process_(options.process,
                 {.on_picture =
                      [this](const cv::Mat3b& picture, const std::string& caption) {
                        publisher_.publish_picture(picture, caption);
                      },
                  .on_forgotten = [this](std::int64_t session) { receiver_.forget(session); }}) {
    if (options.web) web_.emplace(*options.web);
  }

  int run() {
    if (const auto advice = receive_buffer_advice()) spdlog::warn("{}", *advice);
    receiver_.subscribe(bus_);
    BusThread bus_thread(bus_, [this] { receiver_.request_missing(bus_, clock_.now_s()); });
    spdlog::info("viewing {}, pictures in {}", bus_.url(), options_.process.folder.string());
    while (!stop_requested() && !bus_thread.failed()) {
      use_messages();
      write_pictures();
      if (publisher_.status_is_due()) publish_status();
      if (options_.exit_on_final && process_.finished()) break;
    }
    while (auto message = inbox_.take(std::chrono::milliseconds(0))) {
      use(*std::move(message));
    }
    process_.close();
    publish_status();
    publisher_.flush();
    bus_thread.stop();
    return process_.failures() > 0 ? 1 : 0;
  }

 private:
  void use(Message message) {
    if (web_) web_->use(message);
    process_.add(std::move(message), clock_.now_s());
  }

  /// Uses messages for at most 0.1 s, so that pictures are drawn even while messages keep arriving.
  void use_messages() {
    constexpr double kMaxTime_s = 0.1;
    const double start_s = clock_.now_s();
    auto message = inbox_.take(std::chrono::milliseconds(50));
    while (message) {
      const double now_s = clock_.now_s();
      use(*std::move(message));
      if (now_s - start_s >= kMaxTime_s) return;
      message = inbox_.take(std::chrono::milliseconds(0));
    }
  }

  void write_pictures() {
    process_.draw_if_due();
    if (take_write_request()) process_.draw_snapshot_now();
    if (inbox_.is_empty()) process_.write_finals(clock_.now_s(), receiver_.may_still_come());
    if (web_) web_->refresh(process_.current(), process_.status());
  }

  void publish_status() {
    ViewerStatus status = process_.status();
    receiver_.add_to(status);
    status.queue_bytes += static_cast<std::int64_t>(inbox_.bytes());
    publisher_.publish_status(std::move(status));
  }

  const Options& options_;
  Bus bus_;
  ViewerPublisher publisher_;
  Inbox inbox_;
  Receiver receiver_;
  ViewerProcess process_;
  std::optional<WebView> web_;
  PatientClock clock_;
};

/// The log has been read: browsers are shown its map until somebody ends the viewer.
void serve_until_stopped(WebView& web, const ViewerProcess& process) {
  spdlog::info("the log has been read; Ctrl-C ends the viewer");
  while (!stop_requested()) {
    web.refresh(process.current(), process.status());
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

int run_on_log(const Options& options) {
  WholeLogReader log(*options.log);
  ViewerProcess process(options.process, {});
  constexpr double kNow_s = 0.0;  // a log is read as fast as possible: no waiting, no retries
  std::optional<WebView> web;
  if (options.web) web.emplace(*options.web);
  Receiver receiver(
      {.map_name = options.map_name, .has_room = {}},
      [&](Message message) {
        if (web) web->use(message);
        process.add(std::move(message), kNow_s);
      },
      report_bad);
  spdlog::info("viewing {}, pictures in {}", options.log->string(),
               options.process.folder.string());

  while (const auto event = log.next()) {
    receiver.handle(event->channel, event->data);
    process.draw_if_due();
    if (take_write_request()) process.draw_snapshot_now();
    if (web) web->refresh(process.current(), process.status());
    if (stop_requested()) break;
  }
  process.close();
  ViewerStatus status = process.status();
  receiver.add_to(status);
  if (status.messages_bad > 0) spdlog::warn("{} bad messages", status.messages_bad);
  if (status.chunks_missing > 0) spdlog::warn("{} chunks missing", status.chunks_missing);
  if (!status.problem.empty()) spdlog::warn("{}", status.problem);
  if (log.damage()) spdlog::error("{}", *log.damage());
  if (process.current() == nullptr && !stop_requested()) {
    spdlog::error("{}: holds no slice of {}", options.log->string(),
                  options.map_name.empty() ? "a map" : "the map '" + options.map_name + "'");
    return 1;
  }
  if (web) serve_until_stopped(*web, process);
  return process.failures() > 0 || log.damage() ? 1 : 0;
}

}  // namespace

int run(const Options& options) {
  std::filesystem::create_directories(options.process.folder);
  return options.log ? run_on_log(options) : RunOnBus(options).run();
}

}  // namespace kintsugi::viewer
