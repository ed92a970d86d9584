#include "lcmtypes/bus/bus_thread.hpp"

#include <chrono>
#include <utility>

namespace kintsugi {
namespace {

constexpr std::chrono::milliseconds kTickPeriod{20};

}  // namespace

BusThread::BusThread(Bus& bus, std::function<void()> tick)
    : thread_([this, &bus, tick = std::move(tick)] {
        try {
          run(bus, tick);
        } catch (...) {
          failure_ = std::current_exception();
          failed_ = true;
        }
      }) {}

void BusThread::run(Bus& bus, const std::function<void()>& tick) {
  auto last_tick = std::chrono::steady_clock::now();
  while (!stopping_) {
    bus.handle(kTickPeriod);
    const auto now = std::chrono::steady_clock::now();
    if (tick && now - last_tick >= kTickPeriod) {
      last_tick = now;
      tick();
    }
  }
}

BusThread::~BusThread() { join(); }

void BusThread::stop() {
  join();
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void BusThread::join() {
  stopping_ = true;
  if (thread_.joinable()) thread_.join();
}

}  // namespace kintsugi
