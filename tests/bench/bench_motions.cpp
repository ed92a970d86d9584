// What a correction of the map costs the segmenter: a generated map in patches, all of which or
// some of which a closed loop moves. Compares each result with batch over the corrected points,
// timed in the same run, and prints a Markdown table.
//
//   bench_motions --points 5100000 --runs 5

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <iostream>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include <CLI/CLI.hpp>
#include <oneapi/tbb/global_control.h>

#include "segmenter/core/batch/batch_engine.hpp"
#include "segmenter/core/parameters/presets.hpp"
#include "segmenter/map/segment_map.hpp"
#include "tests/bench/bench_exact_report.hpp"
#include "tests/bench/map_generator.hpp"
#include "tests/bench/map_generator_patches.hpp"

namespace kintsugi::segmenter::bench {
namespace {

constexpr double kResolution_m = 0.01;
constexpr std::int64_t kLargeSegment = 100;  ///< points

struct Options {
  std::filesystem::path map;
  MapConfig generated{.num_points = 5'100'000};  // 4 million of them in voxels of their own
  std::string preset{"objects"};
  double tile_m = 0.25;
  double bend = 0.001;  ///< rad/m: seams between patches open by a quarter of a voxel at most
  std::size_t num_runs = 5;
  std::size_t num_some = 20;
  std::size_t threads = 0;
  bool compares = true;
};

Options parse_command_line(int argc, char** argv) {
  Options options;
  CLI::App app("Corrections of a large map");
  app.add_option("--map", options.map, "PLY with normals and slice_id, or .bin")
      ->check(CLI::ExistingFile);
  app.add_option("--points", options.generated.num_points, "to generate, without --map")
      ->capture_default_str();
  app.add_option("--preset", options.preset, "parameters of the engine")->capture_default_str();
  app.add_option("--tile", options.tile_m, "side of a patch, m")->capture_default_str();
  app.add_option("--bend", options.bend, "most that a correction bends the map, rad/m")
      ->capture_default_str();
  app.add_option("--runs", options.num_runs, "corrections of each kind")->capture_default_str();
  app.add_option("--patches", options.num_some, "that a correction of few patches moves")
      ->capture_default_str();
  app.add_option("--threads", options.threads, "of parallel stages; 0: one for each core")
      ->capture_default_str();
  app.add_flag("--batch,!--no-batch", options.compares, "compare with batch");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::exit(app.exit(error));
  }
  return options;
}

/// Corrections of a map, the batch segmentations of the same points, and what they took.
class CorrectedMap {
 public:
  CorrectedMap(std::vector<CloudSlice> patches, const Options& options)
      : patches_(std::move(patches)),
        next_id_(static_cast<std::int32_t>(patches_.size())),
        places_(patches_.size()),
        bends_(options.bend),
        compares_(options.compares) {
    config_.engine = preset(options.preset);
    config_.engine.resolution_m = static_cast<double>(static_cast<float>(kResolution_m));
    map_.emplace(config_, 1, patches_[0]);
    map_->add(patches_);
  }

  [[nodiscard]] const SegmentMap& map() const { return *map_; }
  [[nodiscard]] const std::vector<CloudSlice>& patches() const { return patches_; }
  [[nodiscard]] bool agrees() const { return agrees_; }

  struct Times {
    Sample ms{};
    Sample cpu_ms{};
    Sample batch_ms{};
    Sample batch_cpu_ms{};
    Sample ratio{};
    Sample kept{};  ///< share of the ids of large segments
    std::size_t num_points = 0;
  };

  /// Moves the patches [first, last) to where the map is bent by `share` of the most.
  void correct(std::size_t first, std::size_t last, double share, Times& times) {
    const std::span<const CloudSlice> moving(patches_.begin() + first, patches_.begin() + last);
    const CloudSlice correction =
        correction_to_arc(moving, share * bends_, next_id_++, ++num_corrections_);
    times.num_points = 0;
    for (std::size_t k = first; k < last; ++k) {
      places_[k] = correction.motions[k - first].X_WP;
      times.num_points += patches_[k].points_W.size();
    }
    const std::vector<std::uint32_t> before = labels();
    const Stopwatch stopwatch;
    map_->add({&correction, 1});
    times.ms.add(stopwatch.wall_ms());
    times.cpu_ms.add(stopwatch.cpu_ms());
    const std::vector<std::uint32_t> after = labels();
    times.kept.add(share_kept(before, after));
    if (compares_) compare_with_batch(after, times);
  }

 private:
  /// The segment of each point, patch after patch.
  [[nodiscard]] std::vector<std::uint32_t> labels() const {
    std::vector<std::uint32_t> labels;
    for (const CloudSlice& patch : patches_) {
      const SliceRecord& slice = *map_->cloud().find_slice(patch.id);
      const auto ids = map_->segment_ids().ids().subspan(slice.first, slice.count);
      labels.insert(labels.end(), ids.begin(), ids.end());
    }
    return labels;
  }

  /// Of the large segments of before: the share of those most of whose points have their id still.
  static double share_kept(const std::vector<std::uint32_t>& before,
                           const std::vector<std::uint32_t>& after) {
    struct Counts {
      std::int64_t all = 0;
      std::int64_t kept = 0;
    };
    std::unordered_map<std::uint32_t, Counts> counts;
    for (std::size_t i = 0; i < before.size(); ++i) {
      Counts& segment = counts[before[i]];
      ++segment.all;
      segment.kept += before[i] == after[i];
    }
    std::int64_t num_large = 0;
    std::int64_t num_kept = 0;
    for (const auto& [id, segment] : counts) {
      if (segment.all < kLargeSegment) continue;
      ++num_large;
      num_kept += 2 * segment.kept > segment.all;
    }
    return static_cast<double>(num_kept) /
           static_cast<double>(std::max<std::int64_t>(num_large, 1));
  }

  void compare_with_batch(const std::vector<std::uint32_t>& labels, Times& times) {
    PointCloud cloud(config_.engine.resolution_m);
    for (std::size_t k = 0; k < patches_.size(); ++k) {
      cloud.add_slice(patches_[k].id, moved(patches_[k].points_W, places_[k]));
    }
    const CloudChange everything = cloud.take_change();
    BatchEngine batch(cloud, config_.engine);
    const Stopwatch stopwatch;
    batch.update(everything);
    times.batch_ms.add(stopwatch.wall_ms());
    times.batch_cpu_ms.add(stopwatch.cpu_ms());
    times.ratio.add(times.ms.values().back() / times.batch_ms.values().back());
    const std::vector<PointIndex> truth = canonical_labels(batch.components());
    if (canonical_labels(labels) != truth) agrees_ = false;
  }

  std::vector<CloudSlice> patches_;
  std::int32_t next_id_;
  std::int32_t num_corrections_ = 0;
  std::vector<PatchPose> places_;
  double bends_;
  bool compares_;
  bool agrees_ = true;
  SegmentMapConfig config_;
  std::optional<SegmentMap> map_;
};

void print(const std::string& name, const CorrectedMap::Times& times) {
  print_row({name, count(times.num_points), number(times.ms.quantile(0.5)),
             number(times.cpu_ms.quantile(0.5)), number(times.batch_ms.quantile(0.5)),
             number(times.batch_cpu_ms.quantile(0.5)), number(times.ratio.quantile(0.5)),
             number(100.0 * times.kept.quantile(0.0))});
}

int run(const Options& options) {
  std::optional<oneapi::tbb::global_control> limit;
  if (options.threads > 0) {
    limit.emplace(oneapi::tbb::global_control::max_allowed_parallelism, options.threads);
  }
  CorrectedMap map(cut_into_patches(options.map.empty() ? generate_map(options.generated)
                                                        : read_map(options.map),
                                    options.tile_m, kResolution_m),
                   options);
  const std::size_t num_patches = map.patches().size();
  std::cout << count(num_patches) << " patches of " << count(map.map().cloud().num_live())
            << " points\n\n";
  print_head({"patches that move", "points", "correction, ms", "CPU, ms", "batch, ms",
              "batch, CPU, ms", "ratio", "ids kept, %"});
  CorrectedMap::Times all;
  for (std::size_t k = 0; k < options.num_runs; ++k) {
    map.correct(0, num_patches, k % 2 == 0 ? 1.0 : 0.5, all);
  }
  print("all", all);
  CorrectedMap::Times some;
  const std::size_t num_some = std::min(options.num_some, num_patches);
  for (std::size_t k = 0; k < options.num_runs; ++k) {
    const std::size_t first =
        (num_patches - num_some) * k / std::max<std::size_t>(options.num_runs, 1);
    map.correct(first, first + num_some, 0.3, some);
  }
  print(count(num_some), some);
  if (options.compares) {
    std::cout << "\nall results equal batch: " << (map.agrees() ? "yes" : "NO") << '\n';
  }
  return map.agrees() ? 0 : 1;
}

}  // namespace
}  // namespace kintsugi::segmenter::bench

int main(int argc, char** argv) {
  using namespace kintsugi::segmenter::bench;
  try {
    return run(parse_command_line(argc, argv));
  } catch (const std::exception& error) {
    std::cerr << "bench_motions: " << error.what() << '\n';
    return 2;
  }
}
