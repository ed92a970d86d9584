// faulty_link: a bad network between two buses on one host. Forwards each datagram from one bus to
// the other, or drops, duplicates, delays or reorders it.

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>

#include <poll.h>

#include "lcmtypes/base/stop_signal.hpp"
#include "tests/support/bus_program.hpp"
#include "tests/support/faulty_path.hpp"
#include "tests/support/multicast_port.hpp"

namespace kintsugi::testing {
namespace {

struct Options {
  std::string from = "udpm://239.255.76.67:7667?ttl=0";
  std::string to = "udpm://239.255.76.67:7668?ttl=0";
  std::string report;
  FaultyPath::Config path;
};

void add_flags(CLI::App& app, Options& options) {
  app.add_option("--from", options.from, "One bus")->capture_default_str();
  app.add_option("--to", options.to, "The other bus")->capture_default_str();
  app.add_option("--drop", options.path.drop, "Share of the datagrams that is lost");
  app.add_option("--duplicate", options.path.duplicate, "Share that comes twice");
  app.add_option("--reorder", options.path.hold_back, "Share that later ones overtake");
  app.add_option("--held", options.path.held_s, "How late these come, at most, seconds")
      ->capture_default_str();
  app.add_option("--delay", options.path.delay_s, "How late all come, seconds");
  app.add_option("--seed", options.path.seed, "Decides what becomes of which")
      ->capture_default_str();
  app.add_option("--report", options.report, "Writes at the end what it did (JSON)");
}

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Forwards from one port to the other.
struct Direction {
  MulticastPort& in;
  MulticastPort& out;
  FaultyPath path;

  void pass_on() {
    while (auto datagram = in.receive()) path.put(std::move(*datagram), now_s());
    while (const auto datagram = path.take(now_s())) out.send(*datagram);
  }
};

/// Waits until a datagram arrives or a delayed one is due; at most 0.1 s, to notice signals.
void wait(const std::array<Direction, 2>& directions) {
  double wait_s = 0.1;
  std::array<pollfd, 2> ports{};
  for (std::size_t i = 0; i < directions.size(); ++i) {
    ports[i] = {directions[i].in.descriptor(), POLLIN, 0};
    const auto due_s = directions[i].path.next_due_s();
    if (due_s) wait_s = std::min(wait_s, std::max(0.0, *due_s - now_s()));
  }
  poll(ports.data(), ports.size(), static_cast<int>(std::ceil(wait_s * 1e3)));
}

nlohmann::json report(const Direction& direction) {
  const FaultyPath::Counts& counts = direction.path.counts();
  return {{"in", counts.in},
          {"dropped", counts.dropped},
          {"duplicated", counts.duplicated},
          {"overtaken", counts.overtaken},
          {"out", counts.out},
          {"lost_before", direction.in.lost()}};
}

void run(const Options& options) {
  MulticastPort from(options.from);
  MulticastPort to(options.to);
  FaultyPath::Config back = options.path;
  ++back.seed;
  std::array<Direction, 2> directions{
      {{from, to, FaultyPath(options.path)}, {to, from, FaultyPath(back)}}};
  std::puts("ready");
  std::fflush(stdout);
  while (!stop_requested()) {
    wait(directions);
    for (Direction& direction : directions) direction.pass_on();
  }
  const nlohmann::json done = {{"forth", report(directions[0])}, {"back", report(directions[1])}};
  give_report(done, options.report);
}

}  // namespace
}  // namespace kintsugi::testing

int main(int argc, char** argv) {
  using namespace kintsugi::testing;
  return run_bus_program<Options>(
      argc, argv, "A bad network between two buses on one host, until it is told to stop.",
      add_flags, run);
}
