#include "segmenter/tools/evaluate/live_task.hpp"

#include <iostream>

#include "lcmtypes/base/logger.hpp"
#include "segmenter/evaluation/live/live_report.hpp"
#include "segmenter/evaluation/report/text_file.hpp"

namespace kintsugi::segmenter {

int evaluate_live(const std::filesystem::path& log, const std::filesystem::path& json_file) {
  const LiveConfig config;
  const LiveLogReport result = evaluate_live_log(log, config);
  for (const std::string& remark : result.remarks) spdlog::warn("{}", remark);
  if (!json_file.empty()) write_text_file(json_file, to_json(result));
  std::cout << to_markdown(result, config) << std::flush;
  return result.is_whole ? 0 : 1;
}

}  // namespace kintsugi::segmenter
