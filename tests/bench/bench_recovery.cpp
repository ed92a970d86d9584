// Losses and recoveries of the camera: plays a recording unchanged and with each disturbance.
// Prints a Markdown table; --csv writes the result of each frame.
//
//   bench_recovery --device folder://7scenes_1000 --frames 300
//   bench_recovery --device synthetic://office --disturbances jump,covered --depth-only

#include <exception>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <oneapi/tbb/global_control.h>

#include "tests/bench/recovery_measures.hpp"

namespace kintsugi::mapper::bench {
namespace {

struct Options {
  std::string device;
  int frames = 0;
  std::vector<std::string> disturbances = disturbance_names();
  std::string reference;  ///< empty: chosen by the kind of device
  bool depth_only = false;
  std::uint32_t seed = 1;
  std::size_t threads = 0;
  std::string csv;
  MapperPipeline::Config pipeline;
};

Options parse_command_line(int argc, char** argv) {
  Options options;
  CLI::App app("Loss and recovery of the mapper under disturbances");
  app.add_option("--device", options.device, "folder://PATH or synthetic://NAME?...")->required();
  app.add_option("--frames", options.frames, "number of frames to read; 0: all");
  app.add_option("--disturbances", options.disturbances, "disturbances, in this order")
      ->delimiter(',')
      ->check(CLI::IsMember(disturbance_names()));
  app.add_option(
         "--reference", options.reference,
         "path that poses are compared with: `truth` (default if it is exact) or that of the "
         "`undisturbed` run")
      ->check(CLI::IsMember({"truth", "undisturbed"}));
  app.add_flag("--depth-only", options.depth_only, "without the colour stream");
  app.add_option("--seed", options.seed, "random seed of the disturbances")->capture_default_str();
  app.add_option("--threads", options.threads, "of the parallel stages; 0: one per core");
  app.add_option("--resolution", options.pipeline.volume.resolution_m, "voxel size, m")
      ->capture_default_str();
  auto* volume_size = app.add_option("--volume-size", options.pipeline.volume.volume_size_m,
                                     "a cube of this side, m, not the mapper's default volume");
  app.add_option("--csv", options.csv, "write a line for each frame of each run");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::exit(app.exit(error));
  }
  options.pipeline.patch_side_m = kUsualPatchSide_m;  // the map is corrected
  if (volume_size->count() > 0) {
    options.pipeline.volume.region = RegionShape::kCube;
  } else {
    options.pipeline.set_max_range(0.0);
  }
  return options;
}

std::vector<std::optional<Pose>> reference_path(const Options& options,
                                                const Recording& recording) {
  const bool use_truth =
      options.reference.empty() ? recording.truth_is_exact() : options.reference == "truth";
  if (use_truth) {
    if (!recording.true_path().front()) {
      throw std::invalid_argument(options.device + " has no truth to compare with");
    }
    return recording.true_path();
  }
  return undisturbed_path(recording, !options.depth_only, options.pipeline);
}

std::string in_mm(std::optional<double> metres) {
  if (!metres) return "-";
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << 1e3 * *metres;
  return text.str();
}

void print_header() {
  std::cout
      << "| disturbance | frames | located | parts | fused wrongly | worst, mm | off reference | "
         "worst, mm | good | refused | "
         "recovered / never | until found, median / max, s | ATE, mm | frame, median / max, "
         "ms |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
}

void print_row(const std::string& name, const RecoveryMeasures& m) {
  std::cout << "| " << name << " | " << m.frames << " | " << m.located << " | " << m.parts << " | "
            << m.misplaced << " | " << in_mm(m.worst_misplacement_m) << " | " << m.off << " | "
            << in_mm(m.worst_error_m) << " | " << m.good << " | " << m.refused << std::fixed
            << std::setprecision(1) << " (" << (m.good > 0 ? 100.0 * m.refused / m.good : 0.0)
            << " %) | " << m.recoveries << " / " << m.never_recovered << std::setprecision(2)
            << " | " << m.median_recovery_s << " / " << m.max_recovery_s << " | " << in_mm(m.ate_m)
            << std::setprecision(0) << " | " << m.median_frame_ms << " / " << m.max_frame_ms << " |"
            << std::endl;
}

void write_csv_header(std::ostream& csv) {
  csv << "disturbance,frame,utime,damage,state,reason,view_known,error_m,covered,overlap,"
         "inliers,behind,in_front,rms_m,sigma_m,frame_ms\n";
}

void write_csv(std::ostream& csv, const std::string& name,
               const std::vector<FrameOutcome>& outcomes,
               const std::vector<std::optional<Pose>>& X_WC_reference) {
  for (const FrameOutcome& outcome : outcomes) {
    const TrackingResult& tracking = outcome.tracking;
    const RegistrationQuality& q = tracking.quality;
    const auto& reference = X_WC_reference.at(outcome.planned.frame);
    csv << name << ',' << outcome.planned.frame << ',' << outcome.planned.utime << ','
        << static_cast<int>(outcome.planned.damage) << ',' << static_cast<int>(tracking.state)
        << ',' << (tracking.loss_reason ? to_string(*tracking.loss_reason) : "") << ','
        << outcome.view_known << ',' << (reference ? pose_error_m(tracking.X_WC, *reference) : -1.0)
        << ',' << q.covered_share << ',' << q.overlap_share << ',' << q.inlier_share << ','
        << q.behind_share << ',' << q.in_front_share << ',' << q.rms_m << ',' << q.sigma_m << ','
        << outcome.frame_ms << '\n';
  }
}

void run(const Options& options) {
  const Recording recording(options.device, options.frames);
  const auto X_WC_reference = reference_path(options, recording);
  std::ofstream csv(options.csv);
  write_csv_header(csv);
  print_header();
  for (const std::string& name : options.disturbances) {
    const Plan plan =
        plan_disturbance(name, recording.num_frames(), recording.period_us(), options.seed);
    const auto outcomes =
        run_plan(recording, plan, !options.depth_only, options.pipeline, X_WC_reference);
    print_row(name, measure(outcomes, X_WC_reference, recording.true_path()));
    write_csv(csv, name, outcomes, X_WC_reference);
  }
}

}  // namespace
}  // namespace kintsugi::mapper::bench

int main(int argc, char** argv) {
  using namespace kintsugi::mapper::bench;
  const Options options = parse_command_line(argc, argv);
  try {
    using Limit = oneapi::tbb::global_control;
    std::optional<Limit> limit;
    if (options.threads > 0) limit.emplace(Limit::max_allowed_parallelism, options.threads);
    run(options);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "bench_recovery: " << error.what() << '\n';
    return 1;
  }
}
