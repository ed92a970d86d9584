#include "mapper/process/linger.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

#include "lcmtypes/base/patient_clock.hpp"
#include "lcmtypes/base/stop_signal.hpp"

namespace kintsugi::mapper {
namespace {

constexpr std::chrono::milliseconds kPeriod{50};
constexpr double kStatusPeriod_s = 0.3;

}  // namespace

void linger(const MapPublisher& publisher, double linger_s,
            const std::function<void()>& publish_status) {
  if (linger_s < 0.0) rearm_stop_signals();
  PatientClock clock;
  double next_status_s = 0.0;
  while (!stop_requested()) {
    const double now_s = clock.now_s();
    const double quiet_s = std::min(now_s, publisher.time_since_request_s());
    if (linger_s >= 0.0 && quiet_s >= linger_s) return;
    if (now_s >= next_status_s) {
      publish_status();
      next_status_s = now_s + kStatusPeriod_s;
    }
    std::this_thread::sleep_for(kPeriod);
  }
}

}  // namespace kintsugi::mapper
