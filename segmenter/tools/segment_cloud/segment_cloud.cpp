// kintsugi-segment-cloud: segments a point cloud from a file.

#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <spdlog/sinks/stdout_color_sinks.h>

#include "lcmtypes/base/command_line.hpp"
#include "lcmtypes/base/logger.hpp"
#include "lcmtypes/base/output_files.hpp"
#include "lcmtypes/base/run_main.hpp"
#include "segmenter/io/cloud_input.hpp"
#include "segmenter/io/cloud_slices.hpp"
#include "segmenter/io/formats/cloud_file.hpp"
#include "segmenter/io/labelled_cloud.hpp"
#include "segmenter/io/map_files.hpp"
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
                 "a point cloud: PLY, PCD, LAS, NPY, or text (XYZ, PTS, CSV, ...) with x y z and "
                 "optionally nx ny nz, red green blue, slice_id")
      ->required();
  app.add_option("OUT", options.output,
                 "the PLY file to write: IN with all its properties, and segment_id")
      ->required();
  app.add_option("--json", options.json, "also write the description of every segment as JSON");
  add_cloud_options(app, options.input_config);
  add_segmentation_options(app, options.map);
}

/// A file whose name promises another format would be refused by the program that opens it.
void check_extension(const std::filesystem::path& output) {
  const std::string extension = output.extension().string();
  if (extension == ".ply" || !has_cloud_extension(output)) return;
  throw std::runtime_error("OUT is " + output.string() +
                           ", but it is written as PLY: let its name end in .ply");
}

void validate(const SegmentCloudOptions& options) {
  options.input_config.validate();
  options.map.validate();
  check_extension(options.output);
  check_different({{"IN", options.input}}, {{"OUT", options.output}, {"--json", options.json}});
  for (const auto& file : {options.output, options.json}) check_folder_of(file);
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

/// What the header of the labelled cloud says about it.
std::vector<std::string> comments_on(const CloudInput& input, const SegmentCloudOptions& options) {
  std::vector<std::string> comments{"segmented by kintsugi-segment-cloud, mode " + options.map.mode,
                                    "segment_id 0: a point that cannot be segmented"};
  if (!options.input_config.unit.empty()) comments.push_back("unit " + options.input_config.unit);
  if (!input.origin_W.isZero(0.0)) {
    comments.push_back(
        fmt::format("segmented relative to {:.0f} {:.0f} {:.0f} metres; x y z are not shifted",
                    input.origin_W.x(), input.origin_W.y(), input.origin_W.z()));
  }
  return comments;
}

void run(const SegmentCloudOptions& options) {
  const CloudInput input = read_cloud(options.input, options.input_config);
  const CloudSlices slices =
      cut_into_slices(input.cloud, input.resolution_m, options.input.filename().string());
  const auto map = segment_slices(slices, options.map, [](double share) {
    spdlog::info("segmented {:3.0f} %", 100.0 * share);
  });
  write_labelled_cloud(input, labels_in_input_order(*map, slices), comments_on(input, options),
                       options.output);
  if (!options.json.empty()) {
    write_segments_json(take_snapshot(*map), options.json, input.origin_W);
  }
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
    CLI::App app{"Segments a point cloud from a file (Felzenszwalb and Huttenlocher; Finman)."};
    SegmentCloudOptions options;
    options.input_config.shifts_origin = true;
    options.input_config.labels = LabelUse::kIgnore;  // they are replaced, or pass as they are
    add_options(app, options);
    kintsugi::add_version_flag(app);
    CLI11_PARSE(app, argc, argv);
    validate(options);
    run(options);
    return 0;
  });
}
