#include "mapper/openni2_driver/plugin/camera_ports.hpp"

#include <map>
#include <mutex>

namespace kintsugi::mapper::camera_ports {
namespace {

using Clock = std::chrono::steady_clock;

struct Absence {
  std::int64_t resume_utime = 0;
  std::optional<Clock::time_point> end;  ///< absent: never
};

std::mutex mutex;
std::map<std::string, Absence>& absences() {
  static std::map<std::string, Absence> map;
  return map;
}

}  // namespace

void unplug(const std::string& uri, std::int64_t utime,
            std::optional<std::chrono::microseconds> away) {
  const std::lock_guard lock(mutex);
  Absence& absence = absences()[uri];
  absence = {};
  if (!away) return;
  absence.resume_utime = utime + away->count();
  absence.end = Clock::now() + *away;
}

bool is_plugged_in(const std::string& uri) {
  const std::lock_guard lock(mutex);
  const auto found = absences().find(uri);
  return found == absences().end() || (found->second.end && Clock::now() >= *found->second.end);
}

std::optional<std::int64_t> take_resume_utime(const std::string& uri) {
  const std::lock_guard lock(mutex);
  const auto found = absences().find(uri);
  if (found == absences().end()) return std::nullopt;
  const std::int64_t resume_utime = found->second.resume_utime;
  absences().erase(found);
  return resume_utime;
}

}  // namespace kintsugi::mapper::camera_ports
