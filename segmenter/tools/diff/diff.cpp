// kintsugi-diff: says what has come, gone and moved between two maps of one place.

#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>

#include "lcmtypes/base/command_line.hpp"
#include "lcmtypes/base/logger.hpp"
#include "lcmtypes/base/number_range.hpp"
#include "lcmtypes/base/run_main.hpp"
#include "lcmtypes/base/stop_signal.hpp"
#include "lcmtypes/client/object_text.hpp"
#include "lcmtypes/signing/process_key.hpp"
#include "segmenter/objects/changes/change_files.hpp"
#include "segmenter/objects/maps/observed_map_file.hpp"
#include "segmenter/objects/maps/surface_samples.hpp"
#include "segmenter/objects/process/diff_process.hpp"

namespace kintsugi::segmenter {
namespace {

struct DiffOptions {
  std::filesystem::path before;
  std::filesystem::path after;  ///< empty: the map on the bus
  DiffProcessOptions live;
};

void add_options(CLI::App& app, DiffOptions& options) {
  app.add_option("BEFORE", options.before,
                 "the map before: a saved map (kintsugi-segmenter --save), or an LCM log")
      ->required();
  CLI::Option* const after = app.add_option(
      "AFTER", options.after,
      "the map after, the same; without it the map on the bus is followed until a stop signal, and "
      "its changes are published");
  app.add_option("--out", options.live.out,
                 "folder for changes.json, change_ID.ply and changes.png, made when absent")
      ->required();
  app.add_option("--map-name", options.live.map_name,
                 "on the bus: the map of this name (default: the first one it hears of)")
      ->excludes(after);
  app.add_option("--lcm-url", options.live.lcm_url, "the bus (default: LCM_DEFAULT_URL)")
      ->excludes(after);
  add_log_trust_flags(app);
  app.add_option("--every", options.live.every_s,
                 "on the bus: seconds from one comparison to the next while the map grows")
      ->check(number_range(1.0, 86'400.0))
      ->capture_default_str()
      ->excludes(after);
  app.add_flag("--exit-on-final", options.live.exit_on_final,
               "on the bus: exit when the final slice is segmented and compared");
  app.callback([&options] {
    if (!options.after.empty() && options.live.exit_on_final) {
      throw CLI::ExcludesError("--exit-on-final", "AFTER");
    }
  });
}

ObservedMap read(const std::filesystem::path& path) {
  ObservedMap map = read_observed_map(path);
  spdlog::info("{}: {} points, {} views", path.string(), map.points_W.size(), map.views.size());
  if (map.views.empty()) {
    spdlog::warn("{}: it is not known what its camera saw, so what it lacks counts as not seen",
                 path.string());
  }
  return map;
}

std::string table_row(const MapChange& change) {
  Eigen::AlignedBox3f box;
  for (const CloudPoint& point : change.points()) box.extend(position_of(point));
  const Eigen::Vector3f center = box.center();
  const Eigen::Vector3f size = box.sizes();
  std::string row = fmt::format(
      "{:>4} {:<6} {:>7}  {:7.2f} {:7.2f} {:7.2f}  {:5.2f} {:5.2f} {:5.2f}  "
      "{:5.2f}",
      change.id, to_string(change.kind), change.points().size(), center.x(), center.y(), center.z(),
      size.x(), size.y(), size.z(), change.score);
  if (change.kind == ChangeKind::kMoved) {
    Eigen::AlignedBox3f was;
    for (const CloudPoint& point : change.before) was.extend(position_of(point));
    row += fmt::format("  by {:.2f} m, {:.0f} degrees", (center - was.center()).norm(),
                       Eigen::AngleAxisd(change.X_after_before.linear()).angle() * 57.29578);
  }
  return row;
}

void print(const MapDifference& difference) {
  const MapAlignment& alignment = difference.alignment;
  std::cout << fmt::format(
      "aligned: rms {:.1f} mm, position within {:.1f} mm, rotation within {:.2f} degrees; {:.0f} % "
      "of the smaller map is in both\n",
      1e3 * alignment.rms_m, 1e3 * alignment.sigma_m, alignment.sigma_rad * 57.29578,
      100.0 * alignment.overlap);
  std::cout << fmt::format(
      "{} changes; not seen this time: {} points; not seen before: {} points\n",
      difference.changes.changes.size(), difference.changes.not_seen_again,
      difference.changes.not_seen_before);
  if (difference.changes.changes.empty()) return;
  std::cout << "  id kind    points  centre of the box, m       size, m            score\n";
  for (const MapChange& change : difference.changes.changes) {
    std::cout << table_row(change) << '\n';
  }
}

int run(const DiffOptions& options) {
  const ObservedMap before = read(options.before);
  if (options.after.empty()) return run_diff(before, options.live);
  const ObservedMap after = read(options.after);
  const AlignmentResult aligned = align_maps(before, after);
  if (!aligned.alignment) {
    throw std::runtime_error(options.before.string() + " and " + options.after.string() + ": " +
                             aligned.refusal);
  }
  MapDifference difference{.before = options.before.string(),
                           .after = options.after.string(),
                           .before_session = before.map_session,
                           .after_session = after.map_session,
                           .alignment = *aligned.alignment,
                           .changes = find_changes(before, after, aligned.alignment->X_AB)};
  write_changes(difference, after, options.live.out);
  print(difference);
  return 0;
}

}  // namespace
}  // namespace kintsugi::segmenter

int main(int argc, char** argv) {
  using namespace kintsugi::segmenter;
  return kintsugi::run_main(argv, [&] {
    spdlog::set_default_logger(spdlog::stderr_color_mt("kintsugi-diff"));
    spdlog::set_pattern("%^%l%$: %v");
    CLI::App app{"Says what has come, gone and moved between two maps of one place."};
    DiffOptions options;
    bool is_verbose = false;
    add_options(app, options);
    app.add_flag("--verbose", is_verbose, "tell how the places that were tried fit");
    kintsugi::add_version_flag(app);
    CLI11_PARSE(app, argc, argv);
    if (is_verbose) spdlog::set_level(spdlog::level::debug);
    kintsugi::install_stop_signals();
    return run(options);
  });
}
