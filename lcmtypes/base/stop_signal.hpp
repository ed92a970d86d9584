#pragma once
// Signals to a running process, as flags that its main loop polls.

namespace kintsugi {

/// Installs the handlers: SIGINT and SIGTERM request a stop, SIGUSR1 requests that outputs are
/// written now. A second SIGINT or SIGTERM ends the process at once. Call it at the start of main,
/// before any thread is started.
void install_stop_signals();

bool stop_requested();

/// Clears the request to stop: the next signal requests a stop again, instead of ending the
/// process.
void rearm_stop_signals();

/// Returns true once after each SIGUSR1.
bool take_write_request();

/// Do what the signals do; for tests, and for a process that ends itself.
void request_stop();
void request_write();

}  // namespace kintsugi
