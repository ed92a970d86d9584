#include "lcmtypes/base/stop_signal.hpp"

#include <atomic>
#include <csignal>
#include <initializer_list>

namespace kintsugi {
namespace {

// Set by handlers, which may touch what is lock-free, and read by any thread.
std::atomic<bool> g_stop = false;
std::atomic<bool> g_write = false;
static_assert(std::atomic<bool>::is_always_lock_free);

void on_stop(int signal) {
  if (!g_stop.exchange(true)) return;
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void on_write(int /*signal*/) { g_write = true; }

void install(int signal, void (*handler)(int)) {
  struct sigaction action = {};
  action.sa_handler = handler;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;  // a signal must not make a read or write fail
  sigaction(signal, &action, nullptr);
}

}  // namespace

void install_stop_signals() {
  for (const int signal : {SIGINT, SIGTERM}) install(signal, on_stop);
  install(SIGUSR1, on_write);
}

bool stop_requested() { return g_stop; }

void rearm_stop_signals() { g_stop = false; }

bool take_write_request() { return g_write.exchange(false); }

void request_stop() { g_stop = true; }
void request_write() { g_write = true; }

}  // namespace kintsugi
