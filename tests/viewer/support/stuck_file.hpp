#pragma once

#include <array>
#include <filesystem>

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

namespace kintsugi::viewer {

/// A file that blocks its writer after one page until go_on() is called, however fast or loaded the
/// machine is. It is a named pipe.
class StuckFile {
 public:
  explicit StuckFile(const std::filesystem::path& path) {
    if (mkfifo(path.c_str(), 0666) != 0) return;
    pipe_ = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    fcntl(pipe_, F_SETPIPE_SZ, kPage);
  }
  ~StuckFile() {
    if (pipe_ >= 0) close(pipe_);
  }
  StuckFile(const StuckFile&) = delete;
  StuckFile& operator=(const StuckFile&) = delete;

  /// A writer has written something.
  bool is_being_written() const {
    pollfd state{pipe_, POLLIN, 0};
    return poll(&state, 1, 0) == 1 && (state.revents & POLLIN) != 0;
  }

  /// Reads until the writer closes the file. True when there was more than a page: then the writer
  /// was blocked until this call.
  bool go_on() const {
    fcntl(pipe_, F_SETFL, 0);  // blocking reads
    std::array<char, kPage> page{};
    ssize_t total = 0;
    for (ssize_t bytes = 1; bytes > 0; total += bytes) bytes = read(pipe_, page.data(), kPage);
    return total > kPage;
  }

 private:
  static constexpr int kPage = 4096;

  int pipe_ = -1;
};

}  // namespace kintsugi::viewer
