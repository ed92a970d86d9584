#pragma once
// What must hold whatever the bytes are.

#include <cstdio>
#include <cstdlib>

namespace kintsugi::fuzzing {

/// Ends the program where it does not hold: for libFuzzer that is a finding.
inline void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

}  // namespace kintsugi::fuzzing
