#pragma once
// A simulated clock with scheduled events; minutes take milliseconds, the same in every run.

#include <algorithm>
#include <cstdint>
#include <functional>
#include <queue>
#include <utility>

namespace kintsugi::testing {

/// Calls functions at their times, in order.
class Simulation {
 public:
  double now_s() const { return now_s_; }

  void at(double time_s, std::function<void()> what) {
    events_.push({std::max(time_s, now_s_), num_events_++, std::move(what)});
  }
  void after(double seconds, std::function<void()> what) { at(now_s_ + seconds, std::move(what)); }

  /// Runs until no event is left before `time_s`, or until `done` returns true (may be empty).
  void run_until(double time_s, const std::function<bool()>& done = {}) {
    while (!events_.empty() && events_.top().time_s <= time_s && !(done && done())) {
      Event event = events_.top();
      events_.pop();
      now_s_ = event.time_s;
      event.what();
    }
    if (!done || !done()) now_s_ = time_s;
  }

 private:
  struct Event {
    double time_s = 0.0;
    std::int64_t order = 0;
    std::function<void()> what;

    bool operator<(const Event& other) const {  // the first is the greatest
      return std::pair(other.time_s, other.order) < std::pair(time_s, order);
    }
  };

  std::priority_queue<Event> events_;
  std::int64_t num_events_ = 0;
  double now_s_ = 0.0;
};

}  // namespace kintsugi::testing
