#pragma once

#include <cstdint>

namespace kintsugi {

/// Physical memory of this process, from /proc/self/status; zero where that does not exist.
struct ProcessMemory {
  std::int64_t resident_bytes = 0;
  /// Of these, what is not of a file: what the system cannot take back without a swap of its own.
  std::int64_t anonymous_bytes = 0;
  std::int64_t peak_resident_bytes = 0;
};

ProcessMemory process_memory();

/// Returns to the system what is free anywhere in the heap: by itself the heap returns only what is
/// free at its end, and less the longer it is used. It takes some milliseconds.
void return_free_memory();

}  // namespace kintsugi
