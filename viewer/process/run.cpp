#include "viewer/process/run.hpp"

#include <bit>
#include <chrono>
#include <filesystem>
#include <optional>
#include <utility>

#include <spdlog/spdlog.h>

#include "lcmtypes/base/patient_clock.hpp"
#include "lcmtypes/base/stop_signal.hpp"
#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/bus/bus_thread.hpp"
#include "lcmtypes/log/log_reader.hpp"
#include "viewer/process/announcer.hpp"
#include "viewer/process/inbox.hpp"
#include "viewer/process/receiver.hpp"

namespace kintsugi::viewer {
namespace {

/// Bad messages come in floods: the 1st, 2nd, 4th, 8th ... are reported, all are counted.
void report_bad(std::int64_t count, const std::string& reason) {
  if (std::has_single_bit(static_cast<std::uint64_t>(count))) {
    spdlog::warn("dropped bad message {}: {}", count, reason);
  }
}

/// Uses what has been received, for a moment: drawing has its turn while more comes.
void use_received(Inbox& inbox, Viewer& viewer, PatientClock& clock) {
  constexpr double kMoment_s = 0.1;
  const double start_s = clock.now_s();
  auto message = inbox.take(std::chrono::milliseconds(50));
  while (message) {
    const double now_s = clock.now_s();
    viewer.add(*std::move(message), now_s);
    message = now_s - start_s < kMoment_s ? inbox.take(std::chrono::milliseconds(0)) : std::nullopt;
  }
}

int run_on_bus(const Options& options) {
  Bus bus(options.lcm_url);
  if (const auto advice = receive_buffer_advice()) spdlog::warn("{}", *advice);
  Announcer announcer(bus);
  Inbox inbox(options.max_queue_bytes());
  Receiver receiver(
      {.map_name = options.map_name,
       .receiver = announcer.session(),
       .max_request_bytes = bus.max_message_bytes(),
       .has_room = [&inbox] { return inbox.has_room(); },
       .max_pending_bytes = options.max_queue_bytes()},
      [&](Message message) { inbox.put(std::move(message)); }, report_bad);
  Viewer viewer(options.viewer,
                {.on_picture =
                     [&](const cv::Mat3b& picture, const std::string& caption) {
                       announcer.publish_picture(picture, caption);
                     },
                 .on_forgotten = [&](std::int64_t session) { receiver.forget(session); }});
  PatientClock clock;
  receiver.subscribe(bus);
  BusThread bus_thread(bus, [&] { receiver.ask(bus, clock.now_s()); });
  spdlog::info("viewing {}, pictures in {}", bus.url(), options.viewer.folder.string());

  const auto publish_status = [&] {
    ViewerStatus status = viewer.status();
    receiver.add_to(status);
    status.queue_bytes += static_cast<std::int64_t>(inbox.bytes());
    announcer.publish_status(std::move(status));
  };
  while (!stop_requested() && !bus_thread.failed()) {
    use_received(inbox, viewer, clock);
    viewer.draw_if_due();
    if (take_write_request()) viewer.draw_snapshot_now();
    if (inbox.is_empty()) viewer.write_finals(clock.now_s(), receiver.may_still_come());
    if (announcer.status_due()) publish_status();
    if (options.exit_on_final && viewer.finished()) break;
  }
  while (auto message = inbox.take(std::chrono::milliseconds(0))) {
    viewer.add(*std::move(message), clock.now_s());
  }
  viewer.close();
  publish_status();
  announcer.flush();
  bus_thread.stop();
  return viewer.failures() > 0 ? 1 : 0;
}

int run_on_log(const Options& options) {
  LogReader log(*options.log);
  Viewer viewer(options.viewer,
                {.on_picture = [](const cv::Mat3b&, const std::string&) {}, .on_forgotten = {}});
  constexpr double kNoTimePasses_s = 0.0;
  Receiver receiver(
      {.map_name = options.map_name, .has_room = {}},
      [&](Message message) { viewer.add(std::move(message), kNoTimePasses_s); }, report_bad);
  spdlog::info("viewing {}, pictures in {}", options.log->string(), options.viewer.folder.string());

  while (const auto event = log.next()) {
    receiver.handle(event->channel, event->data);
    viewer.draw_if_due();
    if (take_write_request()) viewer.draw_snapshot_now();
    if (stop_requested()) break;
  }
  viewer.close();
  ViewerStatus status = viewer.status();
  receiver.add_to(status);
  if (status.messages_bad > 0) spdlog::warn("{} bad messages", status.messages_bad);
  if (status.chunks_missing > 0) spdlog::warn("{} chunks missing", status.chunks_missing);
  if (!status.problem.empty()) spdlog::warn("{}", status.problem);
  if (log.damage()) spdlog::error("{}", *log.damage());
  return viewer.failures() > 0 || log.damage() ? 1 : 0;
}

}  // namespace

int run(const Options& options) {
  std::filesystem::create_directories(options.viewer.folder);
  return options.log ? run_on_log(options) : run_on_bus(options);
}

}  // namespace kintsugi::viewer
