#include <exception>

#include <spdlog/spdlog.h>

#include "lcmtypes/base/stop_signal.hpp"
#include "viewer/process/options.hpp"
#include "viewer/process/run.hpp"

int main(int argc, char** argv) {
  using namespace kintsugi;
  try {
    install_stop_signals();
    int exit_code = 0;
    const auto options = viewer::parse_options(argc, argv, exit_code);
    if (!options) return exit_code;
    return viewer::run(*options);
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
    return 2;
  }
}
