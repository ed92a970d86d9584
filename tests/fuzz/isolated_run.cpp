#include "tests/fuzz/isolated_run.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <sstream>
#include <system_error>

#include <oneapi/tbb/global_control.h>
#include <sys/wait.h>
#include <unistd.h>

namespace kintsugi::segmenter::fuzz {
namespace {

[[noreturn]] void throw_errno(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

/// "<steps> <rebuilt> <failure>", the failure empty when there is none.
void send(int out, const Outcome& outcome) {
  const std::string text = std::to_string(outcome.num_steps) + ' ' +
                           std::to_string(outcome.num_rebuilt) + ' ' + outcome.failure.value_or("");
  for (std::size_t sent = 0; sent < text.size();) {
    const ssize_t count = ::write(out, text.data() + sent, text.size() - sent);
    if (count < 0) return;  // the parent sees a message that is too short
    sent += static_cast<std::size_t>(count);
  }
}

std::string receive_all(int in) {
  std::string text;
  std::array<char, 4096> buffer{};
  for (;;) {
    const ssize_t count = ::read(in, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return text;
    text.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

Outcome parse(const std::string& text) {
  Outcome outcome;
  std::istringstream in(text);
  std::string failure;
  in >> outcome.num_steps >> outcome.num_rebuilt;
  in.ignore(1);
  if (std::getline(in, failure)) outcome.failure = failure;
  return outcome;
}

}  // namespace

Outcome run_isolated(const std::function<Outcome()>& run, int timeout_s) {
  std::array<int, 2> pipe{};
  if (::pipe(pipe.data()) != 0) throw_errno("pipe");
  const pid_t child = ::fork();
  if (child < 0) throw_errno("fork");
  if (child == 0) {
    ::close(pipe[0]);
    ::alarm(static_cast<unsigned>(timeout_s));
    const oneapi::tbb::global_control one_thread(
        oneapi::tbb::global_control::max_allowed_parallelism, 1);
    send(pipe[1], run());
    ::_exit(0);
  }
  ::close(pipe[1]);
  const std::string text = receive_all(pipe[0]);
  ::close(pipe[0]);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) throw_errno("waitpid");
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return parse(text);
  Outcome outcome;
  if (!WIFSIGNALED(status)) {
    outcome.failure = "exited with " + std::to_string(WEXITSTATUS(status));
  } else if (WTERMSIG(status) == SIGALRM) {
    outcome.failure = "not done after " + std::to_string(timeout_s) + " s";
  } else {
    outcome.failure = std::string("died: ") + ::strsignal(WTERMSIG(status));
  }
  return outcome;
}

}  // namespace kintsugi::segmenter::fuzz
