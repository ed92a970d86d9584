#include "lcmtypes/base/stop_signal.hpp"

#include <csignal>
#include <initializer_list>

namespace kintsugi {
namespace {

volatile std::sig_atomic_t g_stop = 0;
volatile std::sig_atomic_t g_write = 0;

void on_stop(int signal) {
  if (g_stop != 0) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
  g_stop = 1;
}

void on_write(int /*signal*/) { g_write = 1; }

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

bool stop_requested() { return g_stop != 0; }

void rearm_stop_signals() { g_stop = 0; }

bool take_write_request() {
  if (g_write == 0) return false;
  g_write = 0;  // a signal between the two lines requests what is about to be written anyway
  return true;
}

void request_stop() { g_stop = 1; }
void request_write() { g_write = 1; }

}  // namespace kintsugi
