#include "tests/bench/frame_threads.hpp"

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <iterator>
#include <string>

namespace kintsugi::mapper::bench {
namespace {

double read_ms(clockid_t clock) {
  timespec time{};
  if (clock_gettime(clock, &time) != 0) return 0.0;
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

/// As pthread_getcpuclockid(), but by thread id: the number of a CPU clock on Linux.
clockid_t cpu_clock_of(pid_t thread) {
  constexpr unsigned kPerThread = 4;
  constexpr unsigned kScheduled = 2;
  return static_cast<clockid_t>((~static_cast<unsigned>(thread) << 3U) | kPerThread | kScheduled);
}

}  // namespace

Threads current_threads() {
  Threads threads;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/task")) {
    threads.insert(std::stoi(entry.path().filename().string()));
  }
  return threads;
}

Threads new_threads(const Threads& all, const Threads& known) {
  Threads result;
  std::ranges::set_difference(all, known, std::inserter(result, result.end()));
  return result;
}

double cpu_ms(const Threads& threads) {
  double sum = 0.0;
  for (const pid_t thread : threads) sum += read_ms(cpu_clock_of(thread));
  return sum;
}

double process_cpu_ms() { return read_ms(CLOCK_PROCESS_CPUTIME_ID); }

}  // namespace kintsugi::mapper::bench
