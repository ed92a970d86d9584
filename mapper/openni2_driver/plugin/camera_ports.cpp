#include "mapper/openni2_driver/plugin/camera_ports.hpp"

#include <cstdlib>
#include <map>
#include <mutex>
#include <sstream>

namespace kintsugi::mapper::camera_ports {
namespace {

using Clock = std::chrono::steady_clock;

struct Absence {
  std::int64_t resume_utime = 0;
  std::optional<Clock::time_point> end;  ///< absent: never
};

/// All addresses at which something happened.
struct Ports {
  std::mutex mutex;                          ///< guards what follows
  std::map<std::string, Absence> absences;   ///< by address
  std::map<std::string, std::string> moved;  ///< old address to new one
};

Ports& ports() {
  static Ports all;
  return all;
}

bool is_away(const Ports& all, const std::string& uri) {
  const auto found = all.absences.find(uri);
  return found != all.absences.end() && !(found->second.end && Clock::now() >= *found->second.end);
}

}  // namespace

void unplug(const std::string& uri, std::int64_t utime,
            std::optional<std::chrono::microseconds> away, const std::string& new_uri) {
  Ports& all = ports();
  const std::lock_guard lock(all.mutex);
  all.absences[uri] = {};
  if (!away) return;
  all.absences[new_uri] = {.resume_utime = utime + away->count(), .end = Clock::now() + *away};
  if (new_uri != uri) all.moved[uri] = new_uri;
}

bool is_plugged_in(const std::string& uri) {
  Ports& all = ports();
  const std::lock_guard lock(all.mutex);
  return !is_away(all, uri);
}

std::vector<std::string> listed() {
  const char* cameras = std::getenv("KINTSUGI_CAMERAS");
  if (cameras == nullptr) return {};
  Ports& all = ports();
  const std::lock_guard lock(all.mutex);
  std::vector<std::string> plugged_in;
  std::istringstream words(cameras);
  for (std::string uri; words >> uri;) {
    const auto moved = all.moved.find(uri);
    if (moved != all.moved.end()) uri = moved->second;
    if (!is_away(all, uri)) plugged_in.push_back(uri);
  }
  return plugged_in;
}

std::optional<std::int64_t> take_resume_utime(const std::string& uri) {
  Ports& all = ports();
  const std::lock_guard lock(all.mutex);
  const auto found = all.absences.find(uri);
  if (found == all.absences.end()) return std::nullopt;
  const std::int64_t resume_utime = found->second.resume_utime;
  all.absences.erase(found);
  return resume_utime;
}

}  // namespace kintsugi::mapper::camera_ports
