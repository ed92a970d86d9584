// kintsugi-segmenter: segments the slices of mappers incrementally and publishes what changes.

#include <variant>

#include "lcmtypes/base/run_main.hpp"
#include "lcmtypes/base/stop_signal.hpp"
#include "segmenter/process/options.hpp"
#include "segmenter/process/run.hpp"

int main(int argc, char** argv) {
  using namespace kintsugi;
  install_stop_signals();
  return run_main(argv, [&] {
    const auto parsed = segmenter::parse_options(argc, argv);
    if (const int* exit_code = std::get_if<int>(&parsed)) return *exit_code;
    return segmenter::run(std::get<segmenter::Options>(parsed));
  });
}
