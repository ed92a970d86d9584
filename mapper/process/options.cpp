#include "mapper/process/options.hpp"

#include <cmath>
#include <iostream>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include "lcmtypes/base/argument_check.hpp"
#include "lcmtypes/codec/codec.hpp"
#include "mapper/source/openni2/device_listing.hpp"

namespace kintsugi::mapper {
namespace {

constexpr int kDefaultVoxelsPerSide = 512;
constexpr std::string_view kSyntheticScheme = "synthetic://";

void add_source_flags(CLI::App& app, Options& options) {
  app.option_defaults()->group("Where frames come from");
  app.add_option("--device", options.source.device,
                 "a .oni file, folder://PATH, synthetic://NAME, lcm://CHANNEL or a camera's URI; "
                 "empty: the first camera");
  app.add_option("--calibration", options.source.calibration_file,
                 "camera.txt: fx fy cx cy width height depth_scale [k1 k2 p1 p2 k3]");
  app.add_flag("--replay", options.source.replay,
               "every frame of a recording, as fast as they can be mapped");
  app.add_option("--max-range", options.source.max_range_m, "depth beyond it is not used, m");
  app.add_option("--ground-truth", options.ground_truth_dir,
                 "folder into which a synthetic:// device writes what is true");
  app.add_option("--max-frames", options.max_frames, "stop after so many frames; 0: at the end");
}

void add_camera_flags(CLI::App& app, Options& options) {
  app.option_defaults()->group("Cameras");
  app.add_option("--depth-mode", options.source.depth_mode,
                 "WIDTHxHEIGHT[@HZ]; empty: 640x480@30 where offered, else the nearest");
  app.add_option("--color-mode", options.source.color_mode,
                 "WIDTHxHEIGHT[@HZ]; empty: as depth where offered, else what covers it");
  app.add_flag("--assume-registered", options.source.assume_registered,
               "colour fits depth, although the device does not say so (.oni files do not)");
  app.add_option("--lock-exposure", options.lock_exposure_s,
                 "exposure and white balance stay so many s after the first image; -1: never");
  app.add_option("--device-silence", options.source.device_silence_s,
                 "a camera without depth images for so long is gone, s");
  app.add_option("--reconnect", options.source.reconnect_s,
                 "how long to wait for a camera that is gone, s; 0: as long as it takes");
}

void add_mapping_flags(CLI::App& app, Options& options) {
  app.option_defaults()->group("Mapping");
  app.add_option("--volume-size", options.pipeline.volume.volume_size_m,
                 "side of the moving cube, m");
  app.add_option("--resolution", options.resolution_m,
                 "side of a voxel, m; 0: 1/512 of the volume's");
  app.add_option("--shift", options.pipeline.volume.shift_vox,
                 "the cube follows when the camera is so far from its centre, voxels");
  app.add_option("--min-weight", options.pipeline.slices.extractor.weight_threshold,
                 "surface needs more observations than this");
  app.add_option("--trajectory", options.given_path_file,
                 "camera path in TUM format that replaces tracking");
  app.add_option("--threads", options.threads, "of the parallel stages; 0: one per core");
}

void add_output_flags(CLI::App& app, Options& options) {
  app.option_defaults()->group("Files to write");
  app.add_option("--output-trajectory", options.output_path_file, "the camera's path, TUM format");
  app.add_option("--cloud", options.cloud_file, "the points of every slice, PLY");
  app.add_option("--mesh", options.mesh_file, "the surface as triangles, PLY");
  app.add_option("--timings", options.timings_file,
                 "what each frame cost and what became of it, CSV");
}

void add_bus_flags(CLI::App& app, Options& options) {
  app.option_defaults()->group("The bus");
  app.add_flag("--publish-frames", options.publish_frames, "publish RGBD_FRAME too");
  app.add_option("--lcm-url", options.lcm_url, "as LCM has it; empty: LCM's default");
  app.add_option("--map-name", options.map_name, "tells mappers on one bus apart");
  app.add_option("--session", options.session, "number of this run; 0: by the clock");
  app.add_option("--rate", options.rate_mb_s, "most that slices may take of the bus, MB/s");
}

void add_store_flags(CLI::App& app, Options& options) {
  app.option_defaults()->group("So that nothing is lost");
  app.add_option("--store", options.store_file,
                 "LCM log of what is published, for resends; empty: a temporary one");
  app.add_option("--resume", options.resume_file,
                 "log of a run that was interrupted, whose last session goes on");
  app.add_option("--store-file-size", options.store_file_size_mb,
                 "then the log goes on in FILE.1.lcm and so on, MB");
  app.add_flag("--store-frames", options.store_frames,
               "the log keeps the frames too, without loss: so a camera's session can be resumed");
  app.add_option("--linger", options.linger_s,
                 "at the end, stay until nobody has asked for anything for so long, s; -1: until a "
                 "signal");
}

/// The device's own option for where it writes its truth.
void pass_ground_truth_to_device(Options& options) {
  if (options.ground_truth_dir.empty()) return;
  std::string& device = options.source.device;
  if (device.rfind(kSyntheticScheme, 0) != 0) {
    throw std::invalid_argument("--ground-truth is for synthetic:// devices, --device is '" +
                                device + "'");
  }
  device += device.find('?') == std::string::npos ? '?' : '&';
  device += "ground_truth=" + options.ground_truth_dir;
}

/// What follows from the flags, checked.
void complete(Options& options) {
  auto& volume = options.pipeline.volume;
  volume.resolution_m = options.resolution_m == 0.0 ? volume.volume_size_m / kDefaultVoxelsPerSide
                                                    : options.resolution_m;
  options.source.lcm_url = options.lcm_url;
  if (options.lock_exposure_s >= 0.0) {
    options.source.lock_exposure_after_s = options.lock_exposure_s;
  }
  options.validate();
  pass_ground_truth_to_device(options);
  if (!options.given_path_file.empty()) {
    options.pipeline.given_path = read_tum_file(options.given_path_file);
  }
}

}  // namespace

void Options::validate() const {
  source.validate();
  pipeline.validate();
  check_range<std::int64_t>("--max-frames", max_frames, 0, 1'000'000'000);
  check_range<std::int64_t>("--session", session, 0, INT64_MAX);
  check_range("--rate", rate_mb_s, 0.001, 1e6);
  check_range("--store-file-size", store_file_size_mb, 1.0, 1e9);
  if (std::isnan(linger_s)) throw std::invalid_argument("--linger is nan");
  if (!store_file.empty() && !resume_file.empty() && store_file != resume_file) {
    throw std::invalid_argument("--store is '" + store_file + "' and --resume is '" + resume_file +
                                "': a log that is resumed is also the one that is written");
  }
  check_range("--threads", threads, 0, 1024);
  if (std::isnan(lock_exposure_s)) throw std::invalid_argument("--lock-exposure is nan");
  if (!cloud_file.empty() && cloud_file == mesh_file) {
    throw std::invalid_argument("--cloud and --mesh are both '" + cloud_file + "'");
  }
  if (map_name.empty() || map_name.size() > kMaxStringBytes) {
    throw std::invalid_argument("--map-name has " + std::to_string(map_name.size()) +
                                " bytes, must have 1 to " + std::to_string(kMaxStringBytes));
  }
}

std::variant<Options, int> parse_options(int argc, const char* const* argv) {
  Options options;
  CLI::App app{"Maps the RGB-D frames of an OpenNI2 device and publishes the map in slices."};
  app.option_defaults()->always_capture_default();
  add_source_flags(app, options);
  add_camera_flags(app, options);
  add_mapping_flags(app, options);
  add_output_flags(app, options);
  add_bus_flags(app, options);
  add_store_flags(app, options);
  app.option_defaults()->group("Help and configuration");
  app.set_config("--config", "", "read flags from this file (TOML)");
  bool print_config = false;
  app.add_flag("--print-config", print_config, "print every flag with its value, and exit")
      ->configurable(false);
  bool print_devices = false;
  app.add_flag("--list-devices", print_devices,
               "print what the device, or every camera, offers, and exit")
      ->configurable(false);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  }

  if (print_config) {
    std::cout << app.config_to_str(true, true);
    return 0;
  }
  if (print_devices) {
    std::cout << list_devices(options.source.device);
    return 0;
  }
  complete(options);
  return options;
}

}  // namespace kintsugi::mapper
