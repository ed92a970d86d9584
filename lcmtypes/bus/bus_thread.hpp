#pragma once
// The one thread that receives from a Bus.

#include <atomic>
#include <exception>
#include <functional>
#include <thread>

#include "lcmtypes/bus/bus.hpp"

namespace kintsugi {

/// Runs bus.handle() until stopped. Subscribe before; handlers run in this thread.
class BusThread {
 public:
  /// Calls `tick` (may be empty) in this thread, between messages, every 20 ms or soon after: what
  /// receives asks there for what it misses.
  explicit BusThread(Bus& bus, std::function<void()> tick = {});
  /// Stops; a failure that stop() has not reported is lost.
  ~BusThread();
  BusThread(const BusThread&) = delete;
  BusThread& operator=(const BusThread&) = delete;

  /// True when a handler or tick threw: the thread has ended, and stop() throws it.
  bool failed() const { return failed_; }

  /// Ends the thread, and throws what a handler or tick threw. May be called again.
  void stop();

 private:
  void run(Bus& bus, const std::function<void()>& tick);
  void join();

  std::atomic<bool> stopping_{false};
  std::atomic<bool> failed_{false};
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace kintsugi
