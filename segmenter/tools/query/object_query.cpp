#include "segmenter/tools/query/object_query.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/client/object_listener.hpp"

namespace kintsugi::segmenter {
namespace {

using Clock = std::chrono::steady_clock;

// Each detection is repeated about once a second: after two of these and a half, none is missing
// but for repeated losses.
constexpr std::chrono::milliseconds kRepeats{2'500};

/// As many detections are known as the detector says.
bool is_complete(const ObjectListener& listener) {
  const ObjectTable& objects = listener.objects();
  const auto num_heard = std::ssize(objects.entries());
  if (num_heard > 0 && num_heard == objects.num_numbered()) return true;
  const std::optional<DetectorStatus>& detector = listener.detector();
  return detector && detector->session == objects.session() &&
         detector->map_session == objects.map_session() &&
         std::ssize(objects.present()) ==
             detector->detections_found + detector->detections_confirmed;
}

bool is_heard(const ObjectListener& listener) {
  return listener.detector() || listener.objects().session() != 0;
}

FoundObjects found_by(const ObjectListener& listener) {
  const ObjectTable& objects = listener.objects();
  FoundObjects found{.map_name = listener.map_name(),
                     .map_session = objects.map_session(),
                     .session = objects.session(),
                     .newest_utime = 0,
                     .detections = {},
                     .dropped = listener.dropped()};
  for (const auto& [number, entry] : objects.entries()) {
    found.detections.push_back(entry.message);
    found.newest_utime = std::max(found.newest_utime, entry.message.utime);
  }
  return found;
}

}  // namespace

FoundObjects ask_detector(const std::string& lcm_url, const std::string& map_name,
                          std::chrono::duration<double> timeout) {
  Bus bus(lcm_url);
  ObjectListener listener(map_name);
  listener.subscribe(
      bus, [] { return std::chrono::duration<double>(Clock::now().time_since_epoch()).count(); });
  Clock::time_point end = Clock::now() + std::chrono::duration_cast<Clock::duration>(timeout);
  bool was_heard = false;
  while (Clock::now() < end && !is_complete(listener)) {
    bus.handle(std::chrono::milliseconds(50));
    if (is_heard(listener) && !std::exchange(was_heard, true)) {
      end = std::min(end, Clock::now() + kRepeats);
    }
  }
  if (!was_heard && !is_heard(listener)) {
    throw std::runtime_error(fmt::format(
        "no detector of objects was heard within {} s on {}{}; is 'kintsugi-objects detect' "
        "running?",
        timeout.count(), bus.url(), map_name.empty() ? "" : " for map '" + map_name + "'"));
  }
  return found_by(listener);
}

void keep_named(const std::string& name, FoundObjects& found) {
  if (name.empty()) return;
  std::erase_if(found.detections, [&](const ObjectDetection& d) { return d.name != name; });
}

bool any_present(const FoundObjects& found) {
  return std::ranges::any_of(found.detections,
                             [](const ObjectDetection& d) { return is_present(d); });
}

}  // namespace kintsugi::segmenter
