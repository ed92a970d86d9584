#pragma once
// A program of ours, run as a user runs it.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

#include <sys/wait.h>

namespace kintsugi::segmenter::testing {

struct ProgramResult {
  int exit_code = 0;
  std::string output;  ///< standard output and error
};

/// Runs build/.../bin/`name` beside the tests, through the shell.
/// @param log receives the output; arguments must need no quoting
inline ProgramResult run_program(const std::string& name, const std::string& arguments,
                                 const std::filesystem::path& log) {
  const auto here = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  const auto program = here.parent_path() / "bin" / name;
  if (!std::filesystem::exists(program)) {
    throw std::runtime_error(program.string() + " is not built");
  }
  const std::string command = program.string() + " " + arguments + " > " + log.string() + " 2>&1";
  const int status = std::system(command.c_str());  // NOLINT: a test runs a program of its own
  std::ostringstream text;
  text << std::ifstream(log).rdbuf();
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), text.str()};
}

}  // namespace kintsugi::segmenter::testing
