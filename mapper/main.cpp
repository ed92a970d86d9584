// kintsugi-mapper: estimates camera poses from RGB-D frames and publishes the map in slices.

#include <variant>

#include <malloc.h>

#include "lcmtypes/base/run_main.hpp"
#include "lcmtypes/base/stop_signal.hpp"
#include "mapper/process/options.hpp"
#include "mapper/process/run.hpp"

int main(int argc, char** argv) {
  using namespace kintsugi;
  install_stop_signals();
  // Each thread would keep memory of its own that the others cannot use: after four rounds of a
  // room more than all that is in use.
  mallopt(M_ARENA_MAX, 1);
  return run_main(argv, [&] {
    const auto parsed = mapper::parse_options(argc, argv);
    if (const int* exit_code = std::get_if<int>(&parsed)) return *exit_code;
    mapper::run(std::get<mapper::Options>(parsed));
    return 0;
  });
}
