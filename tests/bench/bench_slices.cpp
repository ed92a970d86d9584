// Cost of slices: the shift on the tracking thread, extraction and mesh on the worker thread, and
// memory during the run; for a synthetic scene also the distance of the map from the true surface.
//
//   bench_slices --device folder://7scenes_1000 --frames 300
//   bench_slices --device 'synthetic://office?frames=300' --true-poses
//   bench_slices --device synthetic://loop --only-shifts --step 6
//   bench_slices --device synthetic://two-floors --true-poses --step 3 --mesh mesh.ply

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <iostream>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <oneapi/tbb/global_control.h>
#include <sys/resource.h>

#include "mapper/core/mapper_pipeline.hpp"
#include "mapper/evaluation/surface_error.hpp"
#include "mapper/openni2_driver/recording/recording_uri.hpp"
#include "mapper/output/map_writers.hpp"
#include "mapper/source/open_source.hpp"
#include "mapper/synthetic/render/sequence.hpp"

namespace kintsugi::mapper::bench {
namespace {

struct Options {
  std::string device;
  int frames = 0;
  int step = 1;
  bool true_poses = false;
  bool only_shifts = false;
  bool forget_points = false;
  std::size_t threads = 0;
  int memory_rows = 10;
  std::string cloud;
  std::string mesh;
  MapperPipeline::Config pipeline;
};

Options parse_command_line(int argc, char** argv) {
  Options options;
  CLI::App app("Cost of slices, memory over a run, error of the surface");
  app.add_option("--device", options.device, "folder://PATH or synthetic://NAME?...")->required();
  app.add_option("--frames", options.frames, "number of frames to map; 0: all");
  app.add_option("--step", options.step, "map every Nth frame")->capture_default_str();
  app.add_flag("--true-poses", options.true_poses,
               "use the true poses of a synthetic scene instead of tracking");
  app.add_flag("--only-shifts", options.only_shifts,
               "only shift the volume, along the true path of a synthetic scene");
  app.add_flag("--forget-points", options.forget_points,
               "keep no points, so that the memory is that of the mapper; no surface error");
  app.add_option("--threads", options.threads, "of the parallel stages; 0: one per core");
  app.add_option("--memory-rows", options.memory_rows, "number of times the memory is printed");
  app.add_option("--min-weight", options.pipeline.slices.extractor.weight_threshold)
      ->capture_default_str();
  app.add_option("--max-depth", options.pipeline.integrator.max_depth_m)->capture_default_str();
  app.add_option("--resolution", options.pipeline.volume.resolution_m)->capture_default_str();
  app.add_option("--truncation", options.pipeline.volume.truncation_vox)->capture_default_str();
  app.add_option("--cloud", options.cloud, "write the points to this PLY file");
  app.add_option("--mesh", options.mesh, "write the mesh to this PLY file");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::exit(app.exit(error));
  }
  return options;
}

std::optional<synthetic::Sequence> open_scene(const std::string& device) {
  const auto uri = parse_recording_uri(device);
  if (!uri || uri->scheme != RecordingUri::Scheme::kSynthetic) return std::nullopt;
  return std::optional<synthetic::Sequence>(
      std::in_place, synthetic::Sequence::Config::parse(uri->path, uri->options));
}

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

void print_times(const char* name, const std::vector<double>& ms) {
  std::printf("%-28s n %5zu  median %7.3f  p90 %7.3f  p99 %7.3f  max %7.3f ms\n", name, ms.size(),
              percentile(ms, 0.5), percentile(ms, 0.9), percentile(ms, 0.99), percentile(ms, 1.0));
}

/// One run, from the first frame to the final slice.
class Run {
 public:
  explicit Run(Options options)
      : options_(std::move(options)), scene_(open_scene(options_.device)) {
    if (options_.true_poses) {
      for (int i = 0; i < scene_.value().num_frames(); ++i) {
        options_.pipeline.given_path.push_back({scene_->utime(i), scene_->X_WC(i)});
      }
    }
    if (!scene_) {
      SourceConfig config;
      config.device = options_.device;
      source_ = open_frame_source(config);
    }
    if (!options_.cloud.empty()) cloud_.emplace(options_.cloud);
    if (!options_.mesh.empty()) {
      mesh_.emplace(options_.mesh);
      options_.pipeline.slices.on_mesh = [this](const MeshPiece& piece, const auto& /*runs*/) {
        mesh_->append(piece);
      };
    }
  }

  void play() {
    MapperPipeline pipeline(options_.pipeline);
    const std::int64_t total = scene_ ? scene_->num_frames() / options_.step : 1000;
    const std::int64_t planned = options_.frames == 0 ? total : options_.frames;
    const std::int64_t row = std::max<std::int64_t>(1, planned / options_.memory_rows);
    for (int i = 0; options_.frames == 0 || i < options_.frames; ++i) {
      const auto frame = next_frame(i * options_.step);
      if (!frame) break;
      map(pipeline, *frame);
      if (frame_ms_.size() % static_cast<std::size_t>(row) == 0) print_memory(pipeline);
    }
    const Stopwatch stopwatch;
    take(pipeline.finish());
    std::printf("final slice: %.1f ms\n", stopwatch.elapsed_ms());
    extraction_ms_ = pipeline.extraction_ms();
    if (cloud_) cloud_->commit();
    if (mesh_) {
      for (const WrittenFile& file : mesh_->commit()) num_triangles_ += file.count;
    }
  }

  void report() const {
    print_times("frame", frame_ms_);
    std::printf("%zu slices, %zu points; worker busy %.0f ms, %.2f us a point; lost %d frames\n",
                num_slices_, num_points_, extraction_ms_,
                1e3 * extraction_ms_ / static_cast<double>(num_points_), num_lost_);
    if (mesh_) std::printf("mesh of %ld triangles\n", static_cast<long>(num_triangles_));
    if (!scene_ || options_.forget_points) return;
    const Pose X_SW = options_.true_poses ? Pose::Identity() : scene_->X_WC(0);
    const SurfaceError error = surface_error(points_W_, scene_->scene(), X_SW);
    std::printf(
        "surface error: median %.2f mm, 95 %% %.2f, 99 %% %.2f, max %.1f, mean %.2f; normals "
        "median %.2f deg, 95 %% %.2f; %.0f points a m2\n",
        1e3 * error.median_m, 1e3 * error.percentile_95_m, 1e3 * error.percentile_99_m,
        1e3 * error.max_m, 1e3 * error.mean_m, error.median_normal_deg,
        error.percentile_95_normal_deg, error.points_per_m2);
  }

 private:
  /// Of a synthetic scene only the mapped frames are rendered; of a recording all frames are read.
  std::optional<RgbdFrame> next_frame(int index) {
    if (!scene_) {
      for (; num_read_ < index; ++num_read_) source_->next();
      ++num_read_;
      return source_->next();
    }
    if (index >= scene_->num_frames()) return std::nullopt;
    RgbdFrame frame;
    frame.utime = scene_->utime(index);
    frame.frame_index = index;
    frame.intrinsics = scene_->intrinsics();
    const cv::Mat_<std::uint16_t> depth_mm = scene_->depth_mm(index);
    depth_mm.convertTo(frame.depth_m, CV_32F, 1e-3);
    frame.depth_m.setTo(std::numeric_limits<float>::quiet_NaN(), depth_mm == 0);
    frame.color_rgb = scene_->truth(index).color_rgb;
    return frame;
  }

  void map(MapperPipeline& pipeline, const RgbdFrame& frame) {
    FrameResult result = pipeline.process(frame);
    const bool is_located = result.tracking.state == TrackingState::kTracking ||
                            result.tracking.state == TrackingState::kGiven;
    if (!is_located) ++num_lost_;
    frame_ms_.push_back(result.times.total_ms());
    take(result.slices);
  }

  void take(const std::vector<CloudSlice>& slices) {
    for (const CloudSlice& slice : slices) {
      ++num_slices_;
      if (cloud_) cloud_->append(slice.points_W);
      num_points_ += slice.points_W.size();
      if (options_.forget_points) continue;
      points_W_.insert(points_W_.end(), slice.points_W.begin(), slice.points_W.end());
    }
  }

  void print_memory(const MapperPipeline& pipeline) const {
    std::printf(
        "frame %5zu: %6ld blocks in the volume, volume %7.1f MB, process at most %7.1f MB\n",
        frame_ms_.size(), static_cast<long>(pipeline.num_blocks()),
        static_cast<double>(pipeline.volume_bytes()) / (1 << 20), peak_memory_mb());
    std::fflush(stdout);
  }

  Options options_;
  std::optional<synthetic::Sequence> scene_;
  std::unique_ptr<FrameSource> source_;  ///< empty for a synthetic scene
  int num_read_ = 0;
  std::optional<CloudWriter> cloud_;
  std::optional<MeshWriter> mesh_;
  std::vector<CloudPoint> points_W_;
  std::vector<double> frame_ms_;
  double extraction_ms_ = 0.0;
  std::size_t num_slices_ = 0;
  std::size_t num_points_ = 0;
  std::int64_t num_triangles_ = 0;
  int num_lost_ = 0;
};

/// Only the shifts of the volume, along the true path of a synthetic scene.
void measure_shifts(const Options& options) {
  synthetic::Sequence scene = open_scene(options.device).value();
  TsdfVolume volume(options.pipeline.volume, scene.X_WC(0).translation());
  const Integrator integrator(options.pipeline.integrator);
  std::vector<double> shift_ms;
  std::vector<double> blocks_leaving;
  std::vector<double> aprons;
  const int num_frames = options.frames == 0 ? scene.num_frames() / options.step : options.frames;
  for (int i = 0; i < num_frames; ++i) {
    const synthetic::RenderedFrame& truth = scene.truth(i * options.step);
    const Stopwatch stopwatch;
    const std::vector<DetachedBlocks> slices = volume.shift_to(truth.X_WC.translation());
    const double elapsed_ms = stopwatch.elapsed_ms();
    for (const DetachedBlocks& slice : slices) {
      blocks_leaving.push_back(static_cast<double>(slice.coords.size()));
      aprons.push_back(static_cast<double>(slice.apron_coords.size()));
    }
    if (!slices.empty()) shift_ms.push_back(elapsed_ms);
    RgbdFrame frame;
    frame.intrinsics = truth.intrinsics;
    frame.depth_m = truth.depth_m;
    frame.color_rgb = truth.color_rgb;
    integrator.integrate(frame, truth.X_WC, volume);
  }
  print_times("shift when a slice leaves", shift_ms);
  std::printf("blocks in a slice: median %.0f, max %.0f; around it: median %.0f, max %.0f\n",
              percentile(blocks_leaving, 0.5), percentile(blocks_leaving, 1.0),
              percentile(aprons, 0.5), percentile(aprons, 1.0));
}

}  // namespace
}  // namespace kintsugi::mapper::bench

int main(int argc, char** argv) {
  using namespace kintsugi::mapper::bench;
  try {
    const Options options = parse_command_line(argc, argv);
    std::optional<tbb::global_control> limit;
    if (options.threads > 0) {
      limit.emplace(tbb::global_control::max_allowed_parallelism, options.threads);
    }
    if (options.only_shifts) {
      measure_shifts(options);
    } else {
      Run run(options);
      run.play();
      run.report();
    }
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "bench_slices: " << error.what() << '\n';
    return 1;
  }
}
