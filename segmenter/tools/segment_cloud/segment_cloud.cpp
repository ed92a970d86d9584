// kintsugi-segment-cloud: segments a point cloud from a file.

#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "lcmtypes/base/command_line.hpp"
#include "lcmtypes/base/run_main.hpp"
#include "segmenter/io/cloud_input.hpp"
#include "segmenter/io/cloud_slices.hpp"
#include "segmenter/io/map_files.hpp"
#include "segmenter/io/ply/labelled_ply_writer.hpp"
#include "segmenter/process/options.hpp"
#include "segmenter/tools/cloud_options.hpp"

namespace kintsugi::segmenter {
namespace {

struct SegmentCloudOptions {
  std::filesystem::path input;
  std::filesystem::path output;
  std::filesystem::path json;
  CloudInputConfig input_config;
  SegmentMapConfig map;
};

void add_options(CLI::App& app, SegmentCloudOptions& options) {
  app.add_option("IN", options.input,
                 "a PLY file: x y z, and optionally nx ny nz, red green blue, slice_id")
      ->required();
  app.add_option("OUT", options.output, "the labelled PLY to write")->required();
  app.add_option("--json", options.json, "also write the description of every segment as JSON");
  add_cloud_options(app, options.input_config);
  add_segmentation_options(app, options.map);
}

void validate(const SegmentCloudOptions& options) {
  options.input_config.validate();
  options.map.validate();
  for (const auto& path : {options.output, options.json}) {
    if (path.has_parent_path() && !std::filesystem::is_directory(path.parent_path())) {
      throw std::runtime_error(path.string() + ": there is no folder " +
                               path.parent_path().string());
    }
  }
}

/// Segments slices in order: all in one run of the engine in mode `batch`, else one by one. Calls
/// `progress` with the share of the points that is done, 0 to 1.
std::unique_ptr<SegmentMap> segment_slices(const CloudSlices& slices,
                                           const SegmentMapConfig& config,
                                           const std::function<void(double)>& progress) {
  const std::span<const CloudSlice> all(slices.slices);
  auto map = std::make_unique<SegmentMap>(config, all.front().session, all.front());
  if (config.mode == "batch") {
    map->add(all);
    return map;
  }
  std::size_t num_points = 0;
  for (const CloudSlice& slice : all) {
    num_points += slice.points_W.size();
  }
  constexpr int kReports = 10;
  std::size_t num_done = 0;
  for (const CloudSlice& slice : all) {
    map->add({&slice, 1});
    const auto tenths_before = kReports * num_done / num_points;
    num_done += slice.points_W.size();
    if (kReports * num_done / num_points > tenths_before) {
      progress(static_cast<double>(num_done) / static_cast<double>(num_points));
    }
  }
  return map;
}

void write_labelled_cloud(const SegmentMap& map, const CloudSlices& slices, const PlyCloud& cloud,
                          const SegmentCloudOptions& options) {
  const auto labels = labels_in_input_order(map, slices);
  LabelledPlyWriter writer(options.output, static_cast<std::int64_t>(cloud.points_W.size()),
                           {"segmented by kintsugi-segment-cloud, mode " + options.map.mode,
                            "segment_id 0: a point that cannot be segmented"});
  for (std::size_t i = 0; i < cloud.points_W.size(); ++i) {
    writer.append(cloud.points_W[i], labels[i], cloud.slice_ids.empty() ? 0 : cloud.slice_ids[i]);
  }
  writer.commit();
  if (!options.json.empty()) {
    write_segments_json(take_snapshot(map), options.json);
  }
}

void run(const SegmentCloudOptions& options) {
  const auto [cloud, resolution_m] = read_cloud(options.input, options.input_config);
  const CloudSlices slices =
      cut_into_slices(cloud, resolution_m, options.input.filename().string());
  const auto map = segment_slices(slices, options.map, [](double share) {
    spdlog::info("segmented {:3.0f} %", 100.0 * share);
  });
  write_labelled_cloud(*map, slices, cloud, options);
  spdlog::info("{}: {} segments of {} points", options.output.string(),
               map->segment_ids().num_segments(), map->cloud().size());
}

}  // namespace
}  // namespace kintsugi::segmenter

int main(int argc, char** argv) {
  using namespace kintsugi::segmenter;
  return kintsugi::run_main(argv, [&] {
    spdlog::set_default_logger(spdlog::stderr_color_mt("kintsugi-segment-cloud"));
    spdlog::set_pattern("%^%l%$: %v");
    CLI::App app{"Segments a point cloud from a PLY file (Felzenszwalb and Huttenlocher; Finman)."};
    SegmentCloudOptions options;
    add_options(app, options);
    kintsugi::add_version_flag(app);
    CLI11_PARSE(app, argc, argv);
    validate(options);
    run(options);
    return 0;
  });
}
