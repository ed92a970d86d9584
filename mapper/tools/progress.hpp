#pragma once

#include <cstdio>

#include <unistd.h>

namespace kintsugi::mapper {

/// One line on standard error that tells how far a tool has got. Only on a terminal: in a file each
/// frame would be left.
class Progress {
 public:
  Progress() = default;
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress() {
    if (is_begun_) std::fputc('\n', stderr);
  }

  void show(int frame, int total) {
    if (::isatty(STDERR_FILENO) == 0) return;
    std::fprintf(stderr, "\rframe %d of %d", frame, total);
    is_begun_ = true;
  }

 private:
  bool is_begun_ = false;
};

}  // namespace kintsugi::mapper
