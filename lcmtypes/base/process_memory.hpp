#pragma once

#include <cstdint>

namespace kintsugi {

/// Physical memory of this process, as Linux tells; zero where it does not.
struct ProcessMemory {
  std::int64_t resident_bytes = 0;
  std::int64_t peak_resident_bytes = 0;
};

ProcessMemory process_memory();

}  // namespace kintsugi
