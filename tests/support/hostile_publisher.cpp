// hostile_publisher: sends invalid messages on every channel of a bus.

#include <chrono>
#include <map>
#include <string>
#include <thread>

#include "lcmtypes/base/stop_signal.hpp"
#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/channels.hpp"
#include "tests/support/bus_program.hpp"
#include "tests/support/hostile_messages.hpp"

namespace kintsugi::testing {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

struct Options {
  std::string url;
  double rate_hz = 1000.0;
  double seconds = 60.0;
  double listen_s = 0.0;
  std::uint64_t seed = 1;
  std::size_t max_bytes = 60'000;
  std::string report;
};

void add_flags(CLI::App& app, Options& options) {
  app.add_option("--lcm-url", options.url, "The bus; empty: LCM's default");
  app.add_option("--rate", options.rate_hz, "Messages a second")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--seconds", options.seconds, "For how long")->capture_default_str();
  app.add_option("--listen", options.listen_s,
                 "Learns for so many seconds from the bus what to mutate, besides examples");
  app.add_option("--max-bytes", options.max_bytes, "Of a random message")
      ->check(CLI::Range(1, 65'000))
      ->capture_default_str();
  app.add_option("--seed", options.seed, "Decides all messages")->capture_default_str();
  app.add_option("--report", options.report, "Writes how many were sent on each channel (JSON)");
}

void listen(Bus& bus, double seconds, HostileMessages& hostile) {
  using namespace channels;
  for (const char* channel : {kCloudSlice, kCameraPose, kRgbdFrame, kSegmentUpdate, kSnapshot,
                              kMapperStatus, kSegmenterStatus, kViewerStatus, kDetectorStatus,
                              kObjectDetection, kChangeReport, kHeartbeat, kResendRequest}) {
    bus.subscribe(channel, [&hostile, channel](ByteView data) { hostile.learn(channel, data); });
  }
  const Clock::time_point end =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(Seconds(seconds));
  while (Clock::now() < end && !stop_requested()) bus.handle(std::chrono::milliseconds(50));
}

void run(const Options& options) {
  HostileMessages hostile(options.seed, options.max_bytes);
  if (options.listen_s > 0.0) {
    Bus ears(options.url);
    listen(ears, options.listen_s, hostile);
  }
  Bus bus(options.url);
  std::map<std::string, std::int64_t> sent;
  const Clock::time_point start = Clock::now();
  const auto total = static_cast<std::int64_t>(options.seconds * options.rate_hz);
  for (std::int64_t i = 0; i < total && !stop_requested(); ++i) {
    const Seconds due(static_cast<double>(i) / options.rate_hz);
    std::this_thread::sleep_until(start + std::chrono::duration_cast<Clock::duration>(due));
    const HostileMessages::Message message = hostile.next();
    bus.publish(message.channel, message.data);
    ++sent[message.channel];
  }
  const nlohmann::json done = {{"seconds", Seconds(Clock::now() - start).count()}, {"sent", sent}};
  give_report(done, options.report);
}

}  // namespace
}  // namespace kintsugi::testing

int main(int argc, char** argv) {
  using namespace kintsugi::testing;
  return run_bus_program<Options>(
      argc, argv, "Messages that none of our programs would send, on every channel of a bus.",
      add_flags, run);
}
