// kintsugi-evaluate: segments a recorded map slice by slice and writes the tables and figures of
// the paper; or scores its segments against true instances; or compares a camera path with the true
// one; or measures how much of what the camera saw in a live run was in the segment map; or scores
// changes and detected objects.

#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>

#include <CLI/CLI.hpp>
#include <spdlog/sinks/stdout_color_sinks.h>

#include "lcmtypes/base/atomic_file.hpp"
#include "lcmtypes/base/command_line.hpp"
#include "lcmtypes/base/logger.hpp"
#include "lcmtypes/base/run_main.hpp"
#include "lcmtypes/base/version.hpp"
#include "lcmtypes/signing/process_key.hpp"
#include "segmenter/evaluation/report/plot.hpp"
#include "segmenter/evaluation/session/session_cloud.hpp"
#include "segmenter/evaluation/session/session_log.hpp"
#include "segmenter/io/formats/cloud_file.hpp"
#include "segmenter/process/options.hpp"
#include "segmenter/tools/cloud_options.hpp"
#include "segmenter/tools/evaluate/live_task.hpp"
#include "segmenter/tools/evaluate/objects_task.hpp"
#include "segmenter/tools/evaluate/paper_task.hpp"
#include "segmenter/tools/evaluate/quality_task.hpp"
#include "segmenter/tools/evaluate/trajectory_task.hpp"

namespace kintsugi::segmenter {
namespace {

struct EvaluateOptions {
  std::filesystem::path input;
  std::filesystem::path folder;
  CloudInputConfig cloud;
  SegmentMapConfig map;  // its engine
  std::string preset = "paper";
  EvaluationConfig evaluation;
  QualityOptions quality;
  TrajectoryOptions trajectory;
  std::filesystem::path live_log;
  ObjectsOptions objects;

  bool has_objects() const {
    return !objects.changes_folder.empty() || !objects.detections_file.empty() ||
           !objects.times_log.empty();
  }
};

/// The input is a map, a camera path, a live run or what was told of objects, and only one of them.
void require_task(const EvaluateOptions& options) {
  const bool has_path = !options.trajectory.estimate_file.empty();
  const bool has_live = !options.live_log.empty();
  if (has_path && !options.input.empty()) throw CLI::ExcludesError("--trajectory", "IN");
  if (has_live && !options.input.empty()) throw CLI::ExcludesError("--live", "IN");
  if (has_live && has_path) throw CLI::ExcludesError("--live", "--trajectory");
  if (options.has_objects() && (!options.input.empty() || has_live || has_path)) {
    throw CLI::ExcludesError("--changes, --objects or --detection-times",
                             "IN, --live or --trajectory");
  }
  if (has_path || has_live || !options.objects.times_log.empty()) {
    if (options.folder.empty()) return;
    throw CLI::ExcludesError("--out", "--trajectory, --live and --detection-times");
  }
  if (!options.trajectory.json_file.empty()) {
    throw CLI::RequiresError("--json", "--trajectory, --live or --detection-times");
  }
  if (options.has_objects()) return;
  if (options.input.empty()) {
    throw CLI::RequiredError("IN, --trajectory, --live, --changes, --objects or --detection-times");
  }
  if (options.folder.empty()) throw CLI::RequiredError("--out");
}

void add_options(CLI::App& app, EvaluateOptions& options) {
  EvaluationConfig& evaluation = options.evaluation;
  app.add_option("IN", options.input,
                 "an LCM log with CLOUD_SLICE, or a point cloud (*.ply, *.pcd, *.las, *.npy, "
                 "*.xyz, ...), whose "
                 "slice_id gives the slices");
  app.add_option("--out", options.folder,
                 "the folder to write into, made when absent; required with IN");
  app.add_option("--modes", evaluation.modes, "the modes to compare, in this order")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->capture_default_str();
  app.add_option("--batch-every", evaluation.batch_every,
                 "mode batch: run after every N slices; 0: as often as --batch-budget allows")
      ->capture_default_str();
  app.add_option("--batch-budget", evaluation.batch_budget_s,
                 "approximate time for all runs of mode batch together, seconds")
      ->capture_default_str();
  app.add_option("--segments", evaluation.segments,
                 "segments whose theta is plotted: ranks by size, 1 is the largest")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->capture_default_str();
  add_log_trust_flags(app);
  add_segmentation_options(app, options.map, options.preset);
  app.remove_option(app.get_option("--mode"));
  auto* const group = app.add_option_group("Point clouds");
  add_cloud_options(*group, options.cloud);
  add_quality_options(*app.add_option_group("Quality"), options.quality);
  add_trajectory_options(*app.add_option_group("Camera paths"), options.trajectory);
  app.add_option_group("Live runs")
      ->add_option(
          "--live", options.live_log,
          "instead of IN: the log of everything that was on the bus of a live run (run.lcm of "
          "scripts/trio); prints how much of what the camera saw was in the segment map, and how "
          "soon");
  add_objects_options(*app.add_option_group("Changes and objects"), options.objects);
  app.callback([&options] { require_task(options); });
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw std::runtime_error(folder.string() + ": cannot be made: " + error.message());
  AtomicFile(folder / "index.html").stream();  // throws where nothing can be written
}

RecordedSession read(const EvaluateOptions& options) {
  RecordedSession session = has_cloud_extension(options.input)
                                ? read_session_cloud(options.input, options.cloud)
                                : read_session_log(options.input);
  spdlog::info("{}: {} slices, {} points", session.source, session.num_slices,
               session.num_points());
  for (const std::string& remark : session.remarks) spdlog::warn("{}", remark);
  return session;
}

/// Writes the report of the map; returns the exit status.
int evaluate_map(EvaluateOptions options, const std::string& command_line) {
  options.evaluation.engine = options.quality.comparison.engine = options.map.engine;
  options.evaluation.validate();
  options.quality.comparison.validate();
  options.cloud.validate();
  make_folder(options.folder);
  const ReportContext context{command_line, options.preset, kintsugi::version(), gnuplot_version()};
  if (!context.gnuplot_version) {
    spdlog::warn("no gnuplot: figures are left out; it is in the Debian package gnuplot-nox");
  }
  RecordedSession session = read(options);
  const bool is_whole = session.is_whole;
  const bool is_drawn =
      options.quality.truth_file.empty()
          ? report_paper(std::move(session), options.evaluation, context, options.folder)
          : report_quality(session, options.quality, context, options.folder);
  spdlog::info("written: {}", (options.folder / "index.html").string());
  return is_drawn && is_whole ? 0 : 1;
}

}  // namespace
}  // namespace kintsugi::segmenter

int main(int argc, char** argv) {
  using namespace kintsugi::segmenter;
  return kintsugi::run_main(argv, [&] {
    spdlog::set_default_logger(spdlog::stderr_color_mt("kintsugi-evaluate"));
    spdlog::set_pattern("%^%l%$: %v");
    CLI::App app{
        "Segments a recorded map slice by slice and writes the paper's tables and figures; or, "
        "with --ground-truth, scores its segments; or, with --trajectory, computes the errors of a "
        "camera path; or, with --live or --detection-times, measures a live run; or, with "
        "--changes or --objects, scores what was told of objects."};
    EvaluateOptions options;
    add_options(app, options);
    kintsugi::add_version_flag(app);
    CLI11_PARSE(app, argc, argv);
    options.preset = app.get_option("--preset")->as<std::string>();
    if (!options.trajectory.estimate_file.empty()) {
      evaluate_trajectory(options.trajectory);
      return 0;
    }
    if (!options.live_log.empty()) {
      return evaluate_live(options.live_log, options.trajectory.json_file);
    }
    if (!options.objects.times_log.empty()) {
      return evaluate_detection_times(options.objects.times_log, options.trajectory.json_file);
    }
    if (options.has_objects()) {
      evaluate_objects(options.objects, options.folder);
      return 0;
    }
    std::string command_line;
    for (int i = 0; i < argc; ++i) command_line.append(i == 0 ? "" : " ").append(argv[i]);
    return evaluate_map(options, command_line);
  });
}
