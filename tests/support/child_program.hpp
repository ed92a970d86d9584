#pragma once
// Runs a program of this project as a child process of a test.

#include <csignal>
#include <string>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace kintsugi::testing {

/// The constructor starts the program; the destructor kills it if it still runs.
class ChildProgram {
 public:
  /// @param output file for its output; empty: the output of the test
  /// @param max_file_bytes when > 0, writing more than that into one file fails, as on a full disk
  ChildProgram(std::string path, std::vector<std::string> arguments, const std::string& output = {},
               rlim_t max_file_bytes = 0) {
    arguments.insert(arguments.begin(), std::move(path));
    std::vector<char*> argv;
    argv.reserve(arguments.size() + 1);
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    pid_ = fork();
    if (pid_ == 0) become(argv.data(), output, max_file_bytes);
  }
  ~ChildProgram() {
    if (pid_ > 0) {
      kill(pid_, SIGKILL);
      wait();
    }
  }
  ChildProgram(const ChildProgram&) = delete;
  ChildProgram& operator=(const ChildProgram&) = delete;

  void signal(int number) const {
    if (pid_ > 0) kill(pid_, number);
  }

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
  /// Only what may be called after fork() in a process of several threads.
  [[noreturn]] static void become(char* const* argv, const std::string& output,
                                  rlim_t max_file_bytes) {
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
    execv(argv[0], argv);
    _exit(127);
  }

  void note_end(int options) {
    int status = 0;
    if (waitpid(pid_, &status, options) != pid_) return;
    pid_ = 0;
    exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

  int exit_code_ = 0;
  pid_t pid_ = 0;
};

}  // namespace kintsugi::testing
