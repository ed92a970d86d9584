// kintsugi-viewer: draws the map and its segments into pictures and a video.

#include <variant>

#include "lcmtypes/base/run_main.hpp"
#include "lcmtypes/base/stop_signal.hpp"
#include "viewer/process/options.hpp"
#include "viewer/process/run.hpp"

int main(int argc, char** argv) {
  using namespace kintsugi;
  install_stop_signals();
  return run_main(argv, [&] {
    const auto parsed = viewer::parse_options(argc, argv);
    if (const int* exit_code = std::get_if<int>(&parsed)) return *exit_code;
    return viewer::run(std::get<viewer::Options>(parsed));
  });
}
