#pragma once
// Conditions that must hold for every input.

#include <cstdio>
#include <cstdlib>

namespace kintsugi::fuzzing {

/// Aborts the program if the condition does not hold, which libFuzzer reports.
inline void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

}  // namespace kintsugi::fuzzing
