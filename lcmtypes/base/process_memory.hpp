#pragma once

#include <cstdint>

namespace kintsugi {

/// Physical memory of this process, from /proc/self/status; zero where that does not exist.
struct ProcessMemory {
  std::int64_t resident_bytes = 0;
  std::int64_t peak_resident_bytes = 0;
};

ProcessMemory process_memory();

}  // namespace kintsugi
