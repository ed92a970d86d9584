#include "segmenter/process/run.hpp"

#include <spdlog/sinks/stdout_color_sinks.h>

#include "lcmtypes/base/logger.hpp"
#include "segmenter/process/segmenter_process.hpp"

namespace kintsugi::segmenter {

int run(const Options& options) {
  spdlog::set_default_logger(spdlog::stderr_color_mt("kintsugi-segmenter"));
  spdlog::set_pattern("%H:%M:%S.%e segmenter %^%l%$: %v");
  return SegmenterProcess(options.config()).run();
}

}  // namespace kintsugi::segmenter
