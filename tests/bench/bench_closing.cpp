// How long a correction of a whole map takes to reach the clients of a segmenter: publishes a
// generated map in patches on the bus, as a mapper does, waits until a segmenter has published the
// labels of all of it, and then moves all patches, again and again. Prints a Markdown table. The
// segmenter is to be started beside it.
//
//   scripts/private_bus bash -c 'kintsugi-segmenter --out out & bench_closing; kill $!'

#include <chrono>
#include <cstdint>
#include <exception>
#include <iostream>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "lcmtypes/base/patient_clock.hpp"
#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/channels.hpp"
#include "lcmtypes/client/segment_listener.hpp"
#include "lcmtypes/stream/stream_publisher.hpp"
#include "tests/bench/bench_exact_report.hpp"
#include "tests/bench/map_generator.hpp"
#include "tests/bench/map_generator_patches.hpp"

namespace kintsugi::segmenter::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::int64_t kSession = 1;
constexpr char kMapName[] = "map";
constexpr double kResolution_m = 0.01;
constexpr std::size_t kSentBytesKept = 1U << 30U;
constexpr auto kPatience = std::chrono::minutes(10);  ///< on a busy machine

struct Options {
  MapConfig generated{.num_points = 5'100'000};  // 4 million of them in voxels of their own
  double tile_m = 0.25;
  double curvature_per_m = 0.001;  ///< seams open by a quarter of a voxel at most
  std::size_t num_runs = 7;
};

Options parse_command_line(int argc, char** argv) {
  Options options;
  CLI::App app("From corrections of a large map to their labels on the bus");
  app.add_option("--points", options.generated.num_points, "to generate")->capture_default_str();
  app.add_option("--tile", options.tile_m, "side of a patch, m")->capture_default_str();
  app.add_option("--bend", options.curvature_per_m, "most that a correction bends the map, rad/m")
      ->capture_default_str();
  app.add_option("--runs", options.num_runs, "corrections")->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::exit(app.exit(error));
  }
  return options;
}

/// The mapper of a map in patches and a client of its segmenter, on one bus.
class MapOnBus {
 public:
  explicit MapOnBus(std::vector<CloudSlice> patches)
      : patches_(std::move(patches)),
        sent_(kSentBytesKept),
        stream_(bus_, channels::kCloudSlice, kSession, stream_config(bus_), &sent_),
        labels_(kMapName,
                [this](const SegmentUpdate& update) { segmented_.insert(update.slice_id); }) {
    stream_.subscribe(bus_);
    labels_.subscribe(bus_);
    next_id_ = static_cast<std::int32_t>(patches_.size());
    for (CloudSlice& patch : patches_) {
      patch.map_name = kMapName;
      num_points_ += patch.points_W.size();
    }
  }

  [[nodiscard]] std::size_t num_patches() const { return patches_.size(); }
  [[nodiscard]] std::size_t num_points() const { return num_points_; }

  /// Publishes the map, and waits for all its labels.
  void publish_map() {
    for (const CloudSlice& patch : patches_) {
      CloudSlice sent = patch;
      sent.ends_batch = &patch == &patches_.back();
      stream_.publish(std::move(sent));
    }
    wait_for(patches_.back().id);
  }

  /// Moves all patches to where the map is bent. @returns ms until a client has the labels
  double correct(double curvature_per_m) {
    const std::int32_t id = next_id_++;
    CloudSlice correction = correction_to_arc(patches_, curvature_per_m, id, ++num_corrections_);
    const auto begin = Clock::now();
    stream_.publish(std::move(correction));
    wait_for(id);
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
  }

  [[nodiscard]] std::int64_t bytes_sent() const { return stream_.counts().bytes_sent; }

 private:
  static StreamPublisher::Config stream_config(const Bus& bus) {
    StreamPublisher::Config config;
    config.max_chunk_bytes = bus.max_message_bytes();
    config.map_name = kMapName;
    return config;
  }

  /// @throws std::runtime_error when nothing comes
  void wait_for(std::int32_t slice_id) {
    constexpr std::chrono::milliseconds kTick(5);
    const auto deadline = Clock::now() + kPatience;
    while (!segmented_.contains(slice_id)) {
      bus_.handle(kTick);
      labels_.ask(bus_, clock_.now_s());
      if (Clock::now() > deadline) {
        throw std::runtime_error("no labels of slice " + std::to_string(slice_id) +
                                 " have come: is a segmenter on " + bus_.url() + "?");
      }
    }
  }

  std::vector<CloudSlice> patches_;
  std::size_t num_points_ = 0;
  std::int32_t next_id_ = 0;
  std::int32_t num_corrections_ = 0;
  Bus bus_;
  PatientClock clock_;
  RecentChunks sent_;
  StreamPublisher stream_;
  std::set<std::int32_t> segmented_;  ///< ids of slices whose labels have come
  SegmentListener labels_;
};

void run(const Options& options) {
  MapOnBus map(cut_into_patches(generate_map(options.generated), options.tile_m, kResolution_m));
  map.publish_map();
  const std::int64_t map_bytes = map.bytes_sent();
  Sample ms;
  for (std::size_t k = 0; k < options.num_runs; ++k) {
    ms.add(map.correct(options.curvature_per_m * (k % 2 == 0 ? 1.0 : 0.5)));
  }
  const double correction_bytes =
      static_cast<double>(map.bytes_sent() - map_bytes) / static_cast<double>(options.num_runs);
  print_head({"patches that move", "points", "until the labels have come, ms: median", "largest",
              "correction on the bus, kB", "% of the map"});
  print_row({count(map.num_patches()), count(map.num_points()), number(ms.quantile(0.5)),
             number(ms.quantile(1.0)), number(1e-3 * correction_bytes),
             number(100.0 * correction_bytes / static_cast<double>(map_bytes))});
}

}  // namespace
}  // namespace kintsugi::segmenter::bench

int main(int argc, char** argv) {
  using namespace kintsugi::segmenter::bench;
  try {
    run(parse_command_line(argc, argv));
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "bench_closing: " << error.what() << '\n';
    return 2;
  }
}
