#include "lcmtypes/base/run_main.hpp"

#include <exception>
#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <string>

namespace kintsugi {

int run_main(const char* const* argv, const std::function<int()>& run) {
  try {
    const int exit_code = run();
    if (!std::cout.flush()) throw std::runtime_error("standard output cannot be written");
    return exit_code;
  } catch (const std::exception& error) {
    const std::string program = std::filesystem::path(argv[0]).filename();
    std::cout.flush();  // where both go to one file, the message comes last
    std::cerr << program << ": " << error.what() << std::endl;
    return 1;
  }
}

}  // namespace kintsugi
