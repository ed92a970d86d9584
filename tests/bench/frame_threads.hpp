#pragma once
// CPU time of threads that other libraries started.

#include <set>

#include <sys/types.h>

namespace kintsugi::mapper::bench {

/// Threads of this process, by their Linux thread ids.
using Threads = std::set<pid_t>;

Threads current_threads();
/// Those in `all` that are not in `known`.
Threads new_threads(const Threads& all, const Threads& known);

/// CPU time of these threads since their start, ms; 0 for a thread that has ended.
double cpu_ms(const Threads& threads);
/// CPU time of all threads, including those that have ended.
double process_cpu_ms();

}  // namespace kintsugi::mapper::bench
