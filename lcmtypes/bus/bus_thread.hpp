#pragma once
// The thread that receives from a Bus.

#include <atomic>
#include <exception>
#include <functional>
#include <thread>

#include "lcmtypes/bus/bus.hpp"

namespace kintsugi {

/// Runs bus.handle() until stop(). Subscribe before constructing it; handlers run in this thread.
class BusThread {
 public:
  /// @param tick called in this thread between messages, about every 20 ms, for instance to request
  ///   missing chunks; may be empty
  explicit BusThread(Bus& bus, std::function<void()> tick = {});
  /// Ends the thread; an exception that stop() has not thrown is lost.
  ~BusThread();
  BusThread(const BusThread&) = delete;
  BusThread& operator=(const BusThread&) = delete;

  /// True when a handler or `tick` has thrown: the thread has ended, and stop() will throw it.
  bool failed() const { return failed_; }

  /// Ends the thread. May be called again. @throws what a handler or `tick` has thrown
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
