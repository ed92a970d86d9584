#include "viewer/process/options.hpp"

#include <charconv>
#include <cmath>
#include <iostream>
#include <numbers>
#include <stdexcept>

#include <CLI/CLI.hpp>

namespace kintsugi::viewer {
namespace {

constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;

/// "1280x720".
void parse_size(const std::string& text, int& width_px, int& height_px) {
  const char* const end = text.data() + text.size();
  const auto [x, width_error] = std::from_chars(text.data(), end, width_px);
  if (width_error == std::errc() && x != end && *x == 'x') {
    const auto [rest, height_error] = std::from_chars(x + 1, end, height_px);
    if (height_error == std::errc() && rest == end) return;
  }
  throw std::invalid_argument("size is \"" + text + "\", expected WIDTHxHEIGHT in pixels");
}

}  // namespace

std::optional<Options> parse_options(int argc, char** argv, int& exit_code) {
  CLI::App app("Draws the map and its segments off screen, from the bus or from a log.",
               "kintsugi-viewer");
  Options options;
  Viewer::Config& viewer = options.viewer;
  Painter::Config& painter = viewer.painter;
  Renderer::Config& renderer = painter.renderer;
  std::string view = "follow";
  std::string size = std::to_string(renderer.width_px) + "x" + std::to_string(renderer.height_px);
  std::string folder = viewer.folder.string();
  std::string log;
  std::string video;
  std::vector<std::uint32_t> highlight;
  double overview_yaw_deg = std::round(renderer.view.overview_yaw_rad * kDegreesPerRadian);
  double overview_pitch_deg = std::round(renderer.view.overview_pitch_rad * kDegreesPerRadian);
  bool print_config = false;

  app.set_config("--config", "", "Read options from this file; flags override it");
  app.add_flag("--print-config", print_config, "Print all options as a file for --config and exit")
      ->configurable(false);
  app.add_option("--lcm-url", options.lcm_url, "LCM URL; empty: LCM's default");
  app.add_option("--log", log, "Read this LCM log as fast as possible instead of the bus");
  app.add_option("--map-name", options.map_name,
                 "Draw the map with this name (default: the first that is heard)");
  app.add_option("--max-queue", options.max_queue_mb,
                 "Most that is received ahead of drawing, MB; the rest is asked for again later")
      ->check(CLI::Range(1.0, 1e6))
      ->capture_default_str();
  app.add_option("--out", folder, "Folder for the pictures; created where it is missing")
      ->capture_default_str();
  app.add_option("--every", viewer.every_slices, "Slices between two snapshots")
      ->capture_default_str();
  app.add_option("--view", view, "follow, overview, or x,y,z,lookx,looky,lookz (metres, W)")
      ->capture_default_str();
  app.add_option("--size", size, "WIDTHxHEIGHT of the pictures, pixels")->capture_default_str();
  app.add_option("--video", video, "Write a video to this .mp4 file");
  app.add_option("--video-period", viewer.video_period_s, "Map time between two frames, s")
      ->capture_default_str();
  app.add_option("--video-rate", viewer.video_frames_per_s, "Frames per second of the video")
      ->capture_default_str();
  app.add_flag("--plots", painter.plots, "Write plots.png: lag and times over the slices");
  app.add_flag("--label-ids", renderer.label_ids,
               "Write the ids of the largest segments into the pictures of the segments");
  app.add_option("--highlight", highlight,
                 "Show these segments, ID,ID,...: their ids, and everything else dimmed")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::Range(std::uint32_t{1}, UINT32_MAX));
  app.add_option("--timeline", painter.timelines,
                 "Write timeline_ID.png: what became of segment ID; several: ID,ID,...")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::Range(std::uint32_t{1}, UINT32_MAX));
  app.add_flag("--exit-on-final", options.exit_on_final, "Exit when the final map is drawn");
  app.add_option("--drawing-share", painter.max_drawing_share,
                 "Most of the wall time that drawing may take, when reading the bus")
      ->default_val(0.5);
  app.add_option("--follow-radius", renderer.view.follow_radius_m,
                 "The follow view shows the map so far from the camera, m")
      ->capture_default_str();
  app.add_option("--overview-yaw", overview_yaw_deg,
                 "The overview looks so far to the left of the first camera's direction, degrees")
      ->capture_default_str();
  app.add_option("--overview-pitch", overview_pitch_deg,
                 "The overview looks so far below the horizon, degrees")
      ->capture_default_str();
  app.add_option("--splat-radius", renderer.splat.radius_vox,
                 "Radius of the disc drawn for a point, voxels")
      ->capture_default_str();
  app.add_option("--supersampling", renderer.supersampling,
                 "Each pixel is the mean of this many squared")
      ->capture_default_str();

  try {
    app.parse(argc, argv);
    painter.view = parse_view(view);
    parse_size(size, renderer.width_px, renderer.height_px);
    viewer.folder = folder;
    painter.highlight.insert(highlight.begin(), highlight.end());
    renderer.view.overview_yaw_rad = overview_yaw_deg / kDegreesPerRadian;
    renderer.view.overview_pitch_rad = overview_pitch_deg / kDegreesPerRadian;
    if (!log.empty() && !options.lcm_url.empty()) {
      throw std::invalid_argument("--log and --lcm-url: expected one of the two");
    }
    if (!log.empty()) options.log = log;
    if (!video.empty()) viewer.video = video;
    if (options.log) painter.max_drawing_share = 1.0;
    viewer.validate();
  } catch (const CLI::ParseError& error) {
    exit_code = app.exit(error);
    return std::nullopt;
  } catch (const std::invalid_argument& error) {
    std::cerr << "kintsugi-viewer: " << error.what() << '\n';
    exit_code = 2;
    return std::nullopt;
  }
  if (print_config) {
    std::cout << app.config_to_str(true, true);
    exit_code = 0;
    return std::nullopt;
  }
  return options;
}

}  // namespace kintsugi::viewer
