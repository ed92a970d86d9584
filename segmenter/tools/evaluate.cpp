// kintsugi-evaluate: replays a recorded map and writes the tables and figures of the paper; or
// scores its segments against true instances; or holds a camera path against the true one.

#include <chrono>
#include <exception>
#include <filesystem>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "lcmtypes/base/atomic_file.hpp"
#include "segmenter/evaluation/paper/evaluation.hpp"
#include "segmenter/evaluation/paper/report.hpp"
#include "segmenter/evaluation/paper/result_tables.hpp"
#include "segmenter/evaluation/quality/quality_report.hpp"
#include "segmenter/evaluation/report/plot.hpp"
#include "segmenter/process/options.hpp"
#include "segmenter/tools/quality_evaluation.hpp"
#include "segmenter/tools/trajectory_evaluation.hpp"

namespace kintsugi::segmenter {
namespace {

struct Options {
  std::filesystem::path input;
  std::filesystem::path folder;
  CloudInputConfig cloud;
  SegmentMapConfig map;  // its engine
  EvaluationConfig evaluation;
  QualityOptions quality;
  TrajectoryOptions trajectory;
};

/// A map or a camera path, but not both.
void require_task(const Options& options) {
  const bool has_path = !options.trajectory.estimate_file.empty();
  if (has_path && !options.input.empty()) throw CLI::ExcludesError("--trajectory", "IN");
  if (has_path) return;
  if (options.input.empty()) throw CLI::RequiredError("IN or --trajectory");
  if (options.folder.empty()) throw CLI::RequiredError("--out");
}

void add_options(CLI::App& app, Options& options) {
  EvaluationConfig& evaluation = options.evaluation;
  app.add_option("IN", options.input,
                 "an LCM log with CLOUD_SLICE, or a PLY file (*.ply), by its slice_id");
  app.add_option("--out", options.folder,
                 "the folder to write into, made when absent; required with IN");
  app.add_option("--modes", evaluation.modes, "what to compare, in this order")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->capture_default_str();
  app.add_option("--batch-every", evaluation.batch_every,
                 "mode batch: after every so many slices; 0: as often as --batch-budget allows")
      ->capture_default_str();
  app.add_option("--batch-budget", evaluation.batch_budget_s,
                 "seconds that the runs of batch may take together, about")
      ->capture_default_str();
  app.add_option("--segments", evaluation.segments,
                 "whose theta is shown: ranks by size, 1 is the largest")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->capture_default_str();
  add_segmentation_options(app, options.map, "paper");
  app.remove_option(app.get_option("--mode"));
  auto* const group = app.add_option_group("PLY files");
  add_cloud_options(*group, options.cloud);
  add_quality_options(*app.add_option_group("Quality"), options.quality);
  add_trajectory_options(*app.add_option_group("Camera paths"), options.trajectory);
  app.callback([&options] { require_task(options); });
}

/// A line now and then: at most one a second, and the last of each mode.
class ProgressLog {
 public:
  void operator()(const ReplayProgress& progress) {
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

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw std::runtime_error(folder.string() + ": cannot be made: " + error.message());
  AtomicFile(folder / "index.html").stream();  // throws where nothing can be written
}

RecordedSession read(const Options& options) {
  RecordedSession session = options.input.extension() == ".ply"
                                ? read_session_cloud(options.input, options.cloud)
                                : read_session_log(options.input);
  spdlog::info("{}: {} slices, {} points", session.source, session.num_slices,
               session.num_points());
  for (const std::string& remark : session.remarks) spdlog::warn("{}", remark);
  return session;
}

void log_results(const Evaluation& evaluation) {
  for (const ModeResult& mode : evaluation.modes) {
    const SliceTimes times = slice_times(mode.replay);
    const AgreementSummary agreement = summarize(mode.agreements);
    spdlog::info(
        "{}: average {:.2f} ms, max {:.2f} ms a slice, total {:.2f} s; v = 1 for {:.1f} % "
        "of segments",
        mode.replay.mode, times.average_ms, times.max_ms, times.total_s,
        100.0 * agreement.exact_share);
  }
}

bool report_quality(const Options& options, const ReportContext& context) {
  const RecordedSession session = read(options);
  const bool is_drawn = write_quality_report(evaluate_quality_logged(session, options.quality),
                                             context, options.folder);
  return is_drawn && session.is_whole;
}

bool report_performance(const Options& options, const ReportContext& context) {
  const Evaluation evaluation = evaluate(read(options), options.evaluation, ProgressLog());
  const bool is_drawn = write_report(evaluation, context, options.folder);
  log_results(evaluation);
  spdlog::info("memory: {} MB at the end, {} MB at most", evaluation.resident_bytes / 1'000'000,
               evaluation.peak_resident_bytes / 1'000'000);
  return is_drawn && evaluation.session.is_whole;
}

/// Returns the exit status.
int run(Options options, const std::string& command_line) {
  options.evaluation.engine = options.quality.evaluation.engine = options.map.engine;
  options.evaluation.validate();
  options.quality.evaluation.validate();
  options.cloud.validate();
  make_folder(options.folder);
  const ReportContext context{command_line, KINTSUGI_VERSION, gnuplot_version()};
  if (!context.gnuplot_version) {
    spdlog::warn("no gnuplot: figures are left out; it is in the Debian package gnuplot-nox");
  }
  const bool is_whole = options.quality.truth_file.empty() ? report_performance(options, context)
                                                           : report_quality(options, context);
  spdlog::info("written: {}", (options.folder / "index.html").string());
  return is_whole ? 0 : 1;
}

}  // namespace
}  // namespace kintsugi::segmenter

int main(int argc, char** argv) {
  using namespace kintsugi::segmenter;
  spdlog::set_default_logger(spdlog::stderr_color_mt("kintsugi-evaluate"));
  spdlog::set_pattern("%^%l%$: %v");
  CLI::App app{
      "Replays a recorded map slice by slice and writes the paper's tables and figures; or, with "
      "--ground-truth, scores its segments; or, with --trajectory, tells the errors of a camera "
      "path."};
  Options options;
  add_options(app, options);
  CLI11_PARSE(app, argc, argv);
  std::string command_line;
  for (int i = 0; i < argc; ++i) command_line.append(i == 0 ? "" : " ").append(argv[i]);
  try {
    if (!options.trajectory.estimate_file.empty()) {
      evaluate_trajectory(options.trajectory);
      return 0;
    }
    return run(options, command_line);
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
    return 1;
  }
}
