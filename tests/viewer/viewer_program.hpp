#pragma once

#include <csignal>
#include <string>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace kintsugi::viewer {

/// A running kintsugi-viewer.
class Program {
 public:
  /// `max_file_bytes` > 0: writing more than that into one file fails, as on a full disk.
  /// `output`: a file for what it prints; empty: the test's own.
  explicit Program(std::vector<std::string> arguments, rlim_t max_file_bytes = 0,
                   const std::string& output = {}) {
    arguments.insert(arguments.begin(), KINTSUGI_VIEWER);
    std::vector<char*> argv;
    argv.reserve(arguments.size() + 1);
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    pid_ = fork();
    if (pid_ == 0) {
      if (max_file_bytes > 0) {
        const rlimit limit{max_file_bytes, max_file_bytes};
        setrlimit(RLIMIT_FSIZE, &limit);
        std::signal(SIGXFSZ, SIG_IGN);
      }
      if (!output.empty()) {
        const int file = open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
        dup2(file, STDOUT_FILENO);
        dup2(file, STDERR_FILENO);
      }
      execv(argv[0], argv.data());
      _exit(127);
    }
  }
  ~Program() {
    if (pid_ > 0) {
      kill(pid_, SIGKILL);
      wait();
    }
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void signal(int number) const { kill(pid_, number); }

  /// The exit code; negative: the signal that ended it.
  int wait() {
    if (pid_ > 0) note_end(0);
    return exit_code_;
  }

  bool has_ended() {
    if (pid_ > 0) note_end(WNOHANG);
    return pid_ == 0;
  }

 private:
  void note_end(int options) {
    int status = 0;
    if (waitpid(pid_, &status, options) != pid_) return;
    pid_ = 0;
    exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

  int exit_code_ = 0;
  pid_t pid_ = 0;
};

}  // namespace kintsugi::viewer
