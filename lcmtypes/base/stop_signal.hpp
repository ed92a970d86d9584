#pragma once
// What a person asks of a running process by signal, as flags that its main loop polls.

namespace kintsugi {

/// From now on SIGINT and SIGTERM ask to stop, and SIGUSR1 asks to write outputs now. A second
/// SIGINT or SIGTERM ends the process at once. Call at the start of main, before any thread.
void install_stop_signals();

bool stop_requested();

/// The stop that was asked for has been heeded: the next signal asks again, instead of ending the
/// process at once.
void rearm_stop_signals();

/// True once after each SIGUSR1.
bool take_write_request();

/// As though the signals had come; for tests, and for a process that ends itself.
void request_stop();
void request_write();

}  // namespace kintsugi
