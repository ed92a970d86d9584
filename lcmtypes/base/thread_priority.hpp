#pragma once

#include <sys/resource.h>

namespace kintsugi {

/// Of the calling thread only: the rest of the process goes first. A failure is ignored: the thread
/// then competes with the others.
inline void lower_priority_of_thread() {
#ifdef __linux__
  constexpr int kNice = 10;
  setpriority(PRIO_PROCESS, 0, kNice);  // on Linux 0 means this thread
#endif
}

}  // namespace kintsugi
