#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tests/support/child_program.hpp"

namespace kintsugi::viewer {

/// A running kintsugi-viewer.
class Program : public kintsugi::testing::ChildProgram {
 public:
  explicit Program(std::vector<std::string> arguments, rlim_t max_file_bytes = 0,
                   const std::string& output = {})
      : ChildProgram(KINTSUGI_VIEWER, std::move(arguments), output, max_file_bytes) {}
};

}  // namespace kintsugi::viewer
