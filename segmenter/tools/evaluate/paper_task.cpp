#include "segmenter/tools/evaluate/paper_task.hpp"

#include <chrono>
#include <string>
#include <utility>

#include "lcmtypes/base/logger.hpp"
#include "segmenter/evaluation/paper/page.hpp"
#include "segmenter/evaluation/paper/report.hpp"
#include "segmenter/evaluation/paper/result_tables.hpp"

namespace kintsugi::segmenter {
namespace {

/// Logs the progress: at most one line a second, and the last of each mode.
class ProgressLog {
 public:
  void operator()(const MeasurementProgress& progress) {
    const auto now = std::chrono::steady_clock::now();
    if (now < next_ && progress.step < progress.num_steps) return;
    next_ = now + std::chrono::seconds(1);
    spdlog::info("{}: slice {} of {}, {} points, {:.1f} ms, {:.0f} s left", progress.mode,
                 progress.step, progress.num_steps, progress.map_points, progress.last_ms,
                 progress.rest_s);
  }

 private:
  std::chrono::steady_clock::time_point next_{};
};

void log_results(const Evaluation& evaluation) {
  for (const ModeResult& mode : evaluation.modes) {
    const SliceTimes times = slice_times(mode.measured);
    const AgreementSummary agreement = summarize(mode.agreements);
    spdlog::info(
        "{}: average {:.2f} ms, max {:.2f} ms a slice, total {:.2f} s; v = 1 for {:.1f} % "
        "of segments",
        mode.measured.mode, times.average_ms, times.max_ms, times.total_s,
        100.0 * agreement.exact_share);
  }
}

}  // namespace

bool report_paper(RecordedSession session, const EvaluationConfig& config,
                  const ReportContext& context, const std::filesystem::path& folder) {
  const Evaluation evaluation = evaluate(std::move(session), config, ProgressLog());
  const bool is_drawn = write_report(evaluation, context, folder);
  log_results(evaluation);
  if (const std::string remark = remark_on_run(evaluation, context); !remark.empty()) {
    spdlog::warn("{}", remark);
  }
  spdlog::info("memory: {} MB at the end, {} MB at most", evaluation.resident_bytes / 1'000'000,
               evaluation.peak_resident_bytes / 1'000'000);
  return is_drawn;
}

}  // namespace kintsugi::segmenter
