#include "lcmtypes/bus_thread.hpp"

#include <chrono>
#include <utility>

namespace kintsugi {

BusThread::BusThread(Bus& bus)
    : thread_([this, &bus] {
        try {
          while (!stopping_) bus.handle(std::chrono::milliseconds(50));
        } catch (...) {
          failure_ = std::current_exception();
          failed_ = true;
        }
      }) {}

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
