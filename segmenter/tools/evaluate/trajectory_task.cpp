#include "segmenter/tools/evaluate/trajectory_task.hpp"

#include <iostream>
#include <map>

#include <CLI/CLI.hpp>

#include "lcmtypes/base/output_files.hpp"
#include "lcmtypes/trajectory.hpp"
#include "segmenter/evaluation/report/table.hpp"
#include "segmenter/evaluation/report/text_file.hpp"
#include "segmenter/evaluation/trajectory/trajectory_report.hpp"

namespace kintsugi::segmenter {
namespace {

const std::map<std::string, DeltaUnit> kUnits = {{"s", DeltaUnit::kSeconds},
                                                 {"f", DeltaUnit::kFrames},
                                                 {"m", DeltaUnit::kMetres},
                                                 {"deg", DeltaUnit::kDegrees}};

void write_if_named(const std::filesystem::path& path, const std::string& text) {
  if (!path.empty()) write_text_file(path, text);
}

}  // namespace

void add_trajectory_options(CLI::App& app, TrajectoryOptions& options) {
  auto* const trajectory = app.add_option(
      "--trajectory", options.estimate_file,
      "instead of IN: an estimated camera path (TUM format), to compare with --truth");
  auto* const truth = app.add_option("--truth", options.truth_file, "the true path (TUM format)")
                          ->needs(trajectory);
  trajectory->needs(truth);
  app.add_option("--delta", options.relative.delta, "relative error over motions of this size")
      ->needs(trajectory)
      ->capture_default_str();
  app.add_option("--delta-unit", options.relative.delta_unit,
                 "of --delta: s, f (frames), m or deg along the estimate")
      ->needs(trajectory)
      ->transform(CLI::CheckedTransformer(kUnits).description("{s,f,m,deg}"))
      ->default_str("s");
  app.add_flag("--fixed-delta,!--all-pairs", options.relative.fixed_delta,
               "relative error over --delta (default), or of every pose to every other, ignoring "
               "--delta: evaluate_rpe.py with and without its --fixed_delta")
      ->needs(trajectory);
  app.add_option("--csv", options.csv_file, "write the errors as one row of a table")
      ->needs(trajectory);
  app.add_option("--json", options.json_file, "write the errors, or what --live measures, as JSON");
}

void evaluate_trajectory(const TrajectoryOptions& options) {
  check_different({{"--trajectory", options.estimate_file}, {"--truth", options.truth_file}},
                  {{"--csv", options.csv_file}, {"--json", options.json_file}});
  TrajectoryReport report = report_trajectory(read_tum_file(options.estimate_file),
                                              read_tum_file(options.truth_file), options.relative);
  report.estimate_name = options.estimate_file;
  report.truth_name = options.truth_file;
  write_if_named(options.csv_file, to_csv(to_table(report)));
  write_if_named(options.json_file, to_json(report));
  std::cout << to_text(report) << std::flush;
}

}  // namespace kintsugi::segmenter
