#include "viewer/process/options.hpp"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <numbers>
#include <vector>

#include <CLI/CLI.hpp>

#include "lcmtypes/base/argument_check.hpp"
#include "lcmtypes/base/command_line.hpp"
#include "lcmtypes/base/number_range.hpp"
#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/log/whole_log_reader.hpp"
#include "lcmtypes/signing/process_key.hpp"

namespace kintsugi::viewer {
namespace {

constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;
constexpr double kMaxPitch_deg = 85.0;  // from straight above the picture has no upright

/// The options, and the values of flags that are converted after parsing.
struct Flags {
  Options options;
  std::string log;
  std::string folder = options.process.folder.string();
  std::string video;
  std::string http;
  std::string http_token;
  std::string viewpoint = "follow";
  std::string size =
      std::to_string(renderer().width_px) + "x" + std::to_string(renderer().height_px);
  std::vector<std::uint32_t> highlight;
  double overview_yaw_deg = rounded_deg(renderer().viewpoint.overview_yaw_rad);
  double overview_pitch_deg = rounded_deg(renderer().viewpoint.overview_pitch_rad);
  bool print_config = false;
  bool check_only = false;

  Painter::Config& painter() { return options.process.painter; }
  MapRenderer::Config& renderer() { return painter().renderer; }

  static double rounded_deg(double angle_rad) { return std::round(angle_rad * kDegreesPerRadian); }
};

void add_input_flags(CLI::App& app, Flags& flags) {
  Options& options = flags.options;
  app.add_option("--lcm-url", options.lcm_url, "LCM URL; empty: LCM's default");
  add_log_trust_flags(app);
  app.add_option("--log", flags.log, "Read this LCM log as fast as possible instead of the bus");
  app.add_option("--map-name", options.map_name,
                 "Draw the map with this name (default: the first one received)");
  app.add_option("--max-queue", options.max_queue_mb,
                 "Memory for messages that wait while a picture is drawn, MB; further ones are "
                 "refused and requested again")
      ->check(number_range(1.0, 1e6))
      ->capture_default_str();
  app.add_flag("--exit-on-final", options.exit_on_final,
               "Exit when the final pictures are written");
}

void add_output_flags(CLI::App& app, Flags& flags) {
  ViewerProcess::Config& process = flags.options.process;
  app.add_option("--out", flags.folder, "Folder for the pictures; created if it is missing")
      ->capture_default_str();
  app.add_option("--every", process.every_s, "Map time between two snapshots, s")
      ->capture_default_str();
  app.add_option("--size", flags.size, "WIDTHxHEIGHT of the pictures, pixels")
      ->capture_default_str();
  app.add_option("--video", flags.video, "Write a video (H.264) to this .mp4 file");
  app.add_option("--video-rate", process.video_rate_hz,
                 "Pictures of the video in a second, of map time and when it is played")
      ->capture_default_str();
  app.add_option(
         "--map-period", flags.painter().map_period_s,
         "Map time after which a picture of the video has the map anew, s; the camera's image "
         "is always new")
      ->capture_default_str();
  app.add_flag("--plots", flags.painter().plots, "Write plots.png: lag and times over the slices");
  app.add_option("--drawing-share", flags.painter().max_drawing_share,
                 "Largest share of the wall time for drawing; with --log it is 1")
      ->default_val(0.25);
}

void add_segment_flags(CLI::App& app, Flags& flags) {
  const auto add_ids = [&](const std::string& name, std::vector<std::uint32_t>& ids,
                           const std::string& help) {
    app.add_option(name, ids, help)
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(CLI::Range(std::uint32_t{1}, UINT32_MAX));
  };
  app.add_flag("--label-ids", flags.renderer().label_ids,
               "Write the ids of the largest visible segments into the pictures of the segments");
  add_ids("--highlight", flags.highlight,
          "Highlight these segments, ID,ID,...: show their ids and a close-up, dim all others");
  add_ids("--timeline", flags.painter().timelines,
          "Write timeline_ID.png, the history of segment ID; several: ID,ID,...");
}

void add_drawing_flags(CLI::App& app, Flags& flags) {
  MapRenderer::Config& renderer = flags.renderer();
  app.add_option(
         "--view", flags.viewpoint,
         "follow (the camera), overview, or x,y,z,lookx,looky,lookz (eye and target in W, m)")
      ->capture_default_str();
  app.add_option("--follow-radius", renderer.viewpoint.follow_radius_m,
                 "Distance from the camera up to which --view follow shows the map, m")
      ->capture_default_str();
  app.add_option("--overview-yaw", flags.overview_yaw_deg,
                 "Angle of the overview to the left of the first viewing direction, degrees")
      ->check(finite_number())
      ->capture_default_str();
  app.add_option("--overview-pitch", flags.overview_pitch_deg,
                 "Angle of the overview below the horizon, degrees")
      ->check(number_range(-kMaxPitch_deg, kMaxPitch_deg))
      ->capture_default_str();
  app.add_option("--splat-radius", renderer.splat.radius_vox,
                 "Radius of the disc drawn for a point, voxels")
      ->capture_default_str();
  app.add_option("--supersampling", renderer.supersampling,
                 "Each pixel is the mean of this number squared of samples")
      ->capture_default_str();
}

void add_web_flags(CLI::App& app, Flags& flags) {
  auto* const http = app.add_option(
      "--http", flags.http, "Serve the map to browsers at HOST:PORT, for instance 127.0.0.1:8080");
  app.add_option("--http-token", flags.http_token,
                 "Only who brings the first line of this file (16 or more letters and digits) sees "
                 "the map; needed to listen at other than a loopback address")
      ->needs(http);
}

void add_config_flags(CLI::App& app, Flags& flags) {
  add_version_flag(app);
  add_config_flag(app, "Read options from this file; flags override it");
  app.add_flag("--print-config", flags.print_config,
               "Print all options as a file for --config and exit")
      ->configurable(false);
  app.add_flag("--check", flags.check_only,
               "Check the options and exit: 0 if all is well, or with the reason")
      ->configurable(false);
}

/// What a run would refuse at its beginning.
void check_inputs(const Options& options) {
  check_bus_url(options.lcm_url);
  if (options.log) const WholeLogReader readable(*options.log);
}

/// "1280x720".
void parse_size(const std::string& text, int& width_px, int& height_px) {
  const char* const end = text.data() + text.size();
  const auto [x, width_error] = std::from_chars(text.data(), end, width_px);
  if (width_error == std::errc() && x != end && *x == 'x') {
    const auto [rest, height_error] = std::from_chars(x + 1, end, height_px);
    if (height_error == std::errc() && rest == end) return;
  }
  require(false, "--size", '"' + text + '"', "WIDTHxHEIGHT in pixels");
}

/// The options with the converted values, checked.
Options options_of(Flags flags) {
  MapRenderer::Config& renderer = flags.renderer();
  flags.painter().viewpoint = parse_viewpoint(flags.viewpoint);
  flags.painter().highlight.insert(flags.highlight.begin(), flags.highlight.end());
  parse_size(flags.size, renderer.width_px, renderer.height_px);
  renderer.viewpoint.overview_yaw_rad = flags.overview_yaw_deg / kDegreesPerRadian;
  renderer.viewpoint.overview_pitch_rad = flags.overview_pitch_deg / kDegreesPerRadian;
  flags.options.process.folder = flags.folder;
  if (!flags.video.empty()) flags.options.process.video = flags.video;
  if (!flags.log.empty()) {
    require(flags.options.lcm_url.empty(), "--log and --lcm-url are given, must be one of the two");
    flags.options.log = flags.log;
    flags.painter().max_drawing_share = 1.0;
  }
  flags.options.process.validate();
  if (!flags.http.empty()) {
    const Address address = parse_address(flags.http);
    const std::string token = flags.http_token.empty() ? "" : read_token(flags.http_token);
    const Access checked(address, token);
    flags.options.web = {address, token, renderer.splat};
  }
  return flags.options;
}

}  // namespace

std::variant<Options, int> parse_options(int argc, const char* const* argv) {
  CLI::App app("Draws the map and its segments off screen, from the bus or from a log.",
               "kintsugi-viewer");
  Flags flags;
  add_input_flags(app, flags);
  add_output_flags(app, flags);
  add_segment_flags(app, flags);
  add_drawing_flags(app, flags);
  add_web_flags(app, flags);
  add_config_flags(app, flags);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  }
  Options options = options_of(flags);
  if (flags.print_config) {
    std::cout << app.config_to_str(true, true);
    return 0;
  }
  if (flags.check_only) {
    check_inputs(options);
    return 0;
  }
  return options;
}

}  // namespace kintsugi::viewer
