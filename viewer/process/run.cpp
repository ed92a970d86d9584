#include "viewer/process/run.hpp"

#include <bit>
#include <chrono>
#include <filesystem>
#include <utility>

#include <spdlog/spdlog.h>

#include "lcmtypes/bus.hpp"
#include "lcmtypes/bus_thread.hpp"
#include "lcmtypes/log_reader.hpp"
#include "lcmtypes/stop_signal.hpp"
#include "viewer/process/announcer.hpp"
#include "viewer/process/inbox.hpp"

namespace kintsugi::viewer {
namespace {

/// Bad messages come in floods: the 1st, 2nd, 4th, 8th ... are reported, all are counted.
void report_bad(std::int64_t count, const std::string& reason) {
  if (std::has_single_bit(static_cast<std::uint64_t>(count))) {
    spdlog::warn("dropped bad message {}: {}", count, reason);
  }
}

ViewerStatus status_of(const Viewer& viewer, const Receiver& receiver) {
  ViewerStatus status = viewer.status();
  status.chunks_missing = receiver.chunks_missing();
  status.messages_bad = receiver.messages_bad();
  return status;
}

int run_on_bus(const Options& options) {
  Bus bus(options.lcm_url);
  if (const auto advice = receive_buffer_advice()) spdlog::warn("{}", *advice);
  Announcer announcer(bus);
  Viewer viewer(options.viewer, [&](const cv::Mat3b& picture, const std::string& caption) {
    announcer.publish_picture(picture, caption);
  });
  Inbox inbox;
  Receiver receiver([&](Message message) { inbox.put(std::move(message)); }, report_bad);
  receiver.subscribe(bus);
  BusThread bus_thread(bus);
  spdlog::info("viewing {}, pictures in {}", bus.url(), options.viewer.folder.string());

  while (!stop_requested() && !bus_thread.failed()) {
    for (Message& message : inbox.take(std::chrono::milliseconds(50))) {
      viewer.add(std::move(message));
    }
    viewer.draw_if_due();
    if (take_write_request()) viewer.draw_snapshot_now();
    if (viewer.complete()) viewer.write_final();
    if (announcer.status_due()) announcer.publish_status(status_of(viewer, receiver));
    if (options.exit_on_final && viewer.finished()) break;
  }
  for (Message& message : inbox.take(std::chrono::milliseconds(0))) viewer.add(std::move(message));
  viewer.close();
  announcer.publish_status(status_of(viewer, receiver));
  announcer.flush();
  bus_thread.stop();
  return viewer.failures() > 0 ? 1 : 0;
}

int run_on_log(const Options& options) {
  LogReader log(*options.log);
  Viewer viewer(options.viewer, [](const cv::Mat3b&, const std::string&) {});
  Receiver receiver([&](Message message) { viewer.add(std::move(message)); }, report_bad);
  spdlog::info("viewing {}, pictures in {}", options.log->string(), options.viewer.folder.string());

  while (const auto event = log.next()) {
    receiver.handle(event->channel, event->data);
    viewer.draw_if_due();
    if (take_write_request()) viewer.draw_snapshot_now();
    if (stop_requested()) break;
  }
  viewer.close();
  if (receiver.messages_bad() > 0) spdlog::warn("{} bad messages", receiver.messages_bad());
  if (receiver.chunks_missing() > 0) spdlog::warn("{} chunks missing", receiver.chunks_missing());
  if (log.damage()) spdlog::error("{}", *log.damage());
  return viewer.failures() > 0 || log.damage() ? 1 : 0;
}

}  // namespace

int run(const Options& options) {
  std::filesystem::create_directories(options.viewer.folder);
  return options.log ? run_on_log(options) : run_on_bus(options);
}

}  // namespace kintsugi::viewer
