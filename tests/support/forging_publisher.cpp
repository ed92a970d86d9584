// forging_publisher: publishes well-made lies about the map on a bus, whose key it does not have.

#include <chrono>
#include <map>
#include <stdexcept>
#include <string>
#include <thread>

#include "lcmtypes/base/stop_signal.hpp"
#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/channels.hpp"
#include "tests/support/bus_program.hpp"
#include "tests/support/forgeries.hpp"

namespace kintsugi::testing {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

struct Options {
  std::string url;
  double rate_hz = 500.0;
  double seconds = 10.0;
  double listen_s = 60.0;
  std::string report;
};

void add_flags(CLI::App& app, Options& options) {
  app.add_option("--lcm-url", options.url, "The bus; empty: LCM's default");
  app.add_option("--rate", options.rate_hz, "Messages a second")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--seconds", options.seconds, "For how long")->capture_default_str();
  app.add_option("--listen", options.listen_s,
                 "So many seconds at most until the map has begun; then it is listened to for one "
                 "second more")
      ->capture_default_str();
  app.add_option("--report", options.report, "Writes what was sent on each channel (JSON)");
}

Clock::time_point after(double seconds) {
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(Seconds(seconds));
}

/// Without the key: it hears every message as it is.
class Forger {
 public:
  explicit Forger(const Options& options) : options_(options), bus_(options.url, MessageTrust{}) {
    using namespace channels;
    for (const char* channel :
         {kCloudSlice, kCameraPose, kSegmentUpdate, kSegmentQuery, kSegmentAnswer, kMapperStatus,
          kSegmenterStatus, kViewerStatus, kHeartbeat, kResendRequest}) {
      bus_.subscribe(channel, [this, channel](ByteView data) { hear(channel, data); });
    }
  }

  void run() {
    listen();
    const Clock::time_point start = Clock::now();
    const auto total = static_cast<std::int64_t>(options_.seconds * options_.rate_hz);
    for (std::int64_t i = 0; i < total && !stop_requested(); ++i) {
      const Forgeries::Message message = forgeries_.next();
      bus_.publish(message.channel, message.data);
      ++sent_[message.channel];
      const Seconds due(static_cast<double>(i) / options_.rate_hz);
      const auto end = start + std::chrono::duration_cast<Clock::duration>(due);
      while (Clock::now() < end) bus_.handle(std::chrono::milliseconds(1));
    }
    give_report(
        {{"sent", sent_}, {"repeated", forgeries_.num_repeated()}, {"answered", num_answered_}},
        options_.report);
  }

 private:
  void hear(const std::string& channel, ByteView data) {
    if (is_listening_) forgeries_.learn(channel, data);
    if (channel != channels::kSegmentAnswer) return;
    const auto parts = signed_message::split(data);
    const auto answer = decode_chunk<SegmentAnswer>(parts ? parts->message : data);
    if (answer.header.client == Forgeries::kClient) ++num_answered_;
  }

  void listen() {
    const Clock::time_point end = after(options_.listen_s);
    while (!forgeries_.knows_enough() && Clock::now() < end && !stop_requested()) {
      bus_.handle(std::chrono::milliseconds(50));
    }
    if (!forgeries_.knows_enough()) throw std::runtime_error("no map was heard of on the bus");
    const Clock::time_point enough = after(1.0);
    while (Clock::now() < enough) bus_.handle(std::chrono::milliseconds(50));
    is_listening_ = false;  // to its own messages
  }

  const Options& options_;
  Bus bus_;
  Forgeries forgeries_;
  bool is_listening_ = true;
  std::map<std::string, std::int64_t> sent_;
  std::int64_t num_answered_ = 0;
};

void run(const Options& options) { Forger(options).run(); }

}  // namespace
}  // namespace kintsugi::testing

int main(int argc, char** argv) {
  using namespace kintsugi::testing;
  return run_bus_program<Options>(
      argc, argv,
      "Forged and repeated messages about the map on a bus, by somebody who knows everything but "
      "its key.",
      add_flags, run);
}
