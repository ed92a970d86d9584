#include "lcmtypes/base/process_memory.hpp"

#include <fstream>
#include <limits>
#include <string>

#include <malloc.h>

namespace kintsugi {

ProcessMemory process_memory() {
  std::ifstream status("/proc/self/status");
  ProcessMemory memory;
  std::string key;
  while (status >> key) {
    std::int64_t value_kb = 0;
    if (key == "VmRSS:" && status >> value_kb) memory.resident_bytes = value_kb * 1024;
    if (key == "RssAnon:" && status >> value_kb) memory.anonymous_bytes = value_kb * 1024;
    if (key == "VmHWM:" && status >> value_kb) memory.peak_resident_bytes = value_kb * 1024;
    status.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  }
  return memory;
}

void return_free_memory() { malloc_trim(0); }

}  // namespace kintsugi
