// Times of the stages of a frame: runs the mapper's pipeline over a recording or a synthetic room
// and prints a Markdown table, with a column for each number of threads and each voxel size.
//
//   bench_frame --device folder://7scenes_1000
//   bench_frame --device synthetic://office --threads 2 --resolution 0.01 --frames 100

#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "mapper/core/kernels/instruction_set.hpp"
#include "tests/bench/frame_run.hpp"
#include "tests/bench/frame_table.hpp"

namespace kintsugi::mapper::bench {
namespace {

constexpr int kVoxelsPerSide = 512;

struct Options {
  FrameRunConfig run;
  std::vector<int> threads = {1, 2};
  std::vector<double> resolutions_m = {4.5 / kVoxelsPerSide, 0.01, 6.0 / kVoxelsPerSide};
};

Options parse_command_line(int argc, char** argv) {
  Options options;
  CLI::App app("Times of the mapper's stages, frame by frame");
  app.add_option("--device", options.run.device, "folder://PATH, synthetic://NAME, a .oni file")
      ->required();
  app.add_option("--frames", options.run.frames, "number of measured frames")
      ->capture_default_str();
  app.add_option("--warm-up", options.run.warm_up_frames, "frames mapped before the measured ones")
      ->capture_default_str();
  app.add_option("--threads", options.threads, "of the parallel stages")->delimiter(',');
  app.add_option("--resolution", options.resolutions_m,
                 "voxel sizes, m; the volume has 512 voxels a side")
      ->delimiter(',');
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::exit(app.exit(error));
  }
  options.run.device_rests = options.run.device.starts_with("synthetic://");
  return options;
}

void run(Options& options) {
  std::cout << "# " << options.run.device << ", " << options.run.frames << " frames after "
            << options.run.warm_up_frames << ", " << name_of(best_instruction_set());
  if (options.run.device_rests) std::cout << ", mapped while the device does not render";
  std::cout << "\n\n";
  std::vector<FrameRun> runs;
  for (const int threads : options.threads) {
    for (const double resolution_m : options.resolutions_m) {
      options.run.threads = threads;
      options.run.pipeline.volume.resolution_m = resolution_m;
      options.run.pipeline.volume.region = RegionShape::kCube;
      options.run.pipeline.volume.volume_size_m = kVoxelsPerSide * resolution_m;
      runs.push_back(run_frames(options.run));
    }
  }
  print_stage_table(std::cout, runs);
}

}  // namespace
}  // namespace kintsugi::mapper::bench

int main(int argc, char** argv) {
  try {
    auto options = kintsugi::mapper::bench::parse_command_line(argc, argv);
    kintsugi::mapper::bench::run(options);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "bench_frame: " << error.what() << '\n';
    return 1;
  }
}
