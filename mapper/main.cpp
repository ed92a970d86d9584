// kintsugi-mapper: RGB-D frames in, camera poses and cloud slices out.

#include <exception>
#include <memory>
#include <variant>

#include <spdlog/spdlog.h>
#include <tbb/global_control.h>

#include "lcmtypes/base/stop_signal.hpp"
#include "mapper/process/options.hpp"
#include "mapper/process/run_mapper.hpp"

int main(int argc, char** argv) {
  using namespace kintsugi::mapper;
  kintsugi::install_stop_signals();
  try {
    const auto parsed = parse_command_line(argc, argv);
    if (const int* exit_code = std::get_if<int>(&parsed)) return *exit_code;
    const auto& options = std::get<Options>(parsed);

    std::unique_ptr<tbb::global_control> thread_limit;
    if (options.threads > 0) {
      thread_limit = std::make_unique<tbb::global_control>(
          tbb::global_control::max_allowed_parallelism, options.threads);
    }
    run_mapper(options);
    return 0;
  } catch (const std::exception& error) {
    spdlog::error("kintsugi-mapper: {}", error.what());
    return 1;
  }
}
