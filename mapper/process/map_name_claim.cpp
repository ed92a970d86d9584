#include "mapper/process/map_name_claim.hpp"

#include <chrono>
#include <stdexcept>
#include <thread>

#include "lcmtypes/bus/message_subscriber.hpp"
#include "lcmtypes/channels.hpp"

namespace kintsugi::mapper {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kListen{500};
constexpr milliseconds kPoll{10};
constexpr std::int64_t kPeriod_us = 100'000;
constexpr char kClaimChannel[] = "MAP_NAME";  // of the heartbeats: no stream has this name

}  // namespace

MapNameClaim::MapNameClaim(const std::string& lcm_url, const std::string& map_name)
    : map_name_(map_name), number_(new_session()), bus_(lcm_url) {
  subscribe<Heartbeat>(bus_, channels::kHeartbeat,
                       [this](const Heartbeat& heartbeat) { hear(heartbeat); });
  thread_.emplace(bus_, [this] { send_when_due(); });
  const auto end = std::chrono::steady_clock::now() + kListen;
  while (other_ == 0 && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(kPoll);
  if (other_ == 0) return;
  throw std::runtime_error(
      "another mapper with the map name '" + map_name_ + "' is on " + bus_.url() + " (session " +
      std::to_string(other_) +
      "); give this one another --map-name or another bus (--lcm-url, or scripts/trio --private), "
      "or stop the other one");
}

void MapNameClaim::hear(const Heartbeat& heartbeat) {
  if (heartbeat.map_name != map_name_) return;
  const bool is_running = heartbeat.channel == channels::kCloudSlice;
  const bool goes_first = heartbeat.channel == kClaimChannel && heartbeat.session < number_;
  if (is_running || goes_first) other_ = heartbeat.session;
}

void MapNameClaim::send_when_due() {
  const std::int64_t now_us = wall_clock_us();
  if (now_us < next_us_) return;
  next_us_ = now_us + kPeriod_us;
  Heartbeat heartbeat;
  heartbeat.utime = now_us;
  heartbeat.session = number_;
  heartbeat.channel = kClaimChannel;
  heartbeat.map_name = map_name_;
  bus_.publish(channels::kHeartbeat, heartbeat);
}

}  // namespace kintsugi::mapper
