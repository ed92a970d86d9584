#pragma once
// CPU time of threads that are not ours to ask.

#include <set>

#include <sys/types.h>

namespace kintsugi::mapper::bench {

/// Threads of this process, by the system's ids.
using Threads = std::set<pid_t>;

Threads current_threads();
/// Those in `all` that are not in `known`.
Threads new_threads(const Threads& all, const Threads& known);

/// CPU time of these threads so far, milliseconds; a thread that has ended counts as 0.
double cpu_ms(const Threads& threads);
/// Of all threads, also of those that have ended.
double process_cpu_ms();

}  // namespace kintsugi::mapper::bench
