#pragma once
// kintsugi-evaluate, run in a folder of the test's own.

#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/segmenter/tools/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::segmenter::testing {

class EvaluateProgram : public ::testing::Test {
 protected:
  /// Figures need gnuplot; without it the program says so and ends with 1.
  static int expected_exit_code() {
    return std::system("gnuplot --version > /dev/null 2>&1") == 0 ? 0 : 1;
  }
  ProgramResult run(const std::string& arguments) {
    return run_program("kintsugi-evaluate", arguments, folder_ / "output.txt");
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  /// Of a file in the folder `out`.
  std::vector<std::string> lines_of(const std::string& name) const {
    std::ifstream in(folder_ / "out" / name);
    std::vector<std::string> lines;
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
  }

  kintsugi::testing::TemporaryFolder folder_;
};

}  // namespace kintsugi::segmenter::testing
