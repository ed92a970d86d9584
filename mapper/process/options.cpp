#include "mapper/process/options.hpp"

#include <algorithm>
#include <array>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include <CLI/CLI.hpp>

#include "lcmtypes/base/argument_check.hpp"
#include "lcmtypes/base/command_line.hpp"
#include "lcmtypes/codec/codec.hpp"
#include "lcmtypes/signing/process_key.hpp"
#include "mapper/core/frame/sensors.hpp"
#include "mapper/process/output_files.hpp"
#include "mapper/source/open_source.hpp"
#include "mapper/source/openni2/device_listing.hpp"
#include "mapper/source/probe.hpp"

namespace kintsugi::mapper {
namespace {

constexpr std::string_view kSyntheticScheme = "synthetic://";

void add_flag(CLI::App& app, const MapperOption& option) {
  const auto add = [&](auto* value) {
    if constexpr (std::is_same_v<decltype(value), bool*>) {
      app.add_flag(option.flag(), *value, option.help());
    } else {
      app.add_option(option.flag(), *value, option.help());
    }
  };
  std::visit(add, option.value());
}

void add_flags(CLI::App& app, Options& options) {
  app.option_defaults()->always_capture_default();
  for (const OptionGroup& group : option_table(options)) {
    app.option_defaults()->group(group.title);
    for (const MapperOption& option : group.options) add_flag(app, option);
    if (group.title == kBusGroup) add_log_trust_flags(app);
  }
}

/// --ground-truth is an option in the address of a synthetic:// device.
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

/// What --join needs.
void validate_join(const Options& options) {
  if (options.join == options.map_name) {
    throw std::invalid_argument("--join is '" + options.join +
                                "', as --map-name: it names the map of another mapper, and each "
                                "mapper needs a --map-name of its own");
  }
  if (std::max(options.join.size(), options.map_name.size()) > kMaxJoinNameBytes) {
    throw std::invalid_argument("--join: it and --map-name may have " +
                                std::to_string(kMaxJoinNameBytes) + " bytes at most");
  }
  const bool has_keyframes =
      options.slices == "patch" && options.pipeline.close_loops && options.given_path_file.empty();
  if (!has_keyframes) {
    throw std::invalid_argument(
        "--join needs a map that is corrected by loops: without --slices shift, "
        "--no-loop-closure and --trajectory");
  }
}

/// Members whose bounds are checked where they are used, and their flags.
constexpr std::array<std::pair<std::string_view, std::string_view>, 9> kFlagsOfFields = {{
    {"device_silence_s", "--device-silence"},
    {"max_kept_mb", "--kept-memory"},
    {"max_memory_mb", "--volume-memory"},
    {"max_range_m", "--max-range"},
    {"reconnect_s", "--reconnect"},
    {"resolution_m", "--resolution"},
    {"shift_vox", "--shift"},
    {"volume_size_m", "--volume-size"},
    {"weight_threshold", "--min-weight"},
}};

/// @throws std::invalid_argument naming the flag, its value and its bound
void validate_members(const Options& options) {
  try {
    options.pipeline.validate();  // first: the range of the source may follow from it
    options.source.validate();
  } catch (const std::invalid_argument& error) {
    const std::string_view text = error.what();
    for (const auto& [field, flag] : kFlagsOfFields) {
      if (!text.starts_with(std::string(field) + " is ")) continue;
      throw std::invalid_argument(std::string(flag).append(text.substr(field.size())));
    }
    throw;
  }
}

/// @throws std::invalid_argument naming the flag or field, its value and its bound
void validate(const Options& options) {
  validate_members(options);
  Options copy = options;  // the table points to members that can be written
  for (const OptionGroup& group : option_table(copy)) {
    for (const MapperOption& option : group.options) option.check_bounds();
  }
  if (!options.store_file.empty() && !options.resume_file.empty() &&
      options.store_file != options.resume_file) {
    throw std::invalid_argument("--store is '" + options.store_file + "' and --resume is '" +
                                options.resume_file +
                                "': a resumed session is continued in the same log");
  }
  if (options.store_limit_mb > 0 && options.store_frames) {
    throw std::invalid_argument(
        "--store-limit cannot be kept with --store-frames, which needs every frame");
  }
  for (const auto& [is_given, flag] : {std::pair(options.durable, "--durable"),
                                       std::pair(options.store_frames, "--store-frames")}) {
    if (is_given && options.store_file.empty() && options.resume_file.empty()) {
      throw std::invalid_argument(std::string(flag) + " needs --store FILE or --resume FILE");
    }
  }
  check_output_files(options);
  if (options.map_name.empty() || options.map_name.size() > kMaxStringBytes) {
    throw std::invalid_argument("--map-name has " + std::to_string(options.map_name.size()) +
                                " bytes, must have 1 to " + std::to_string(kMaxStringBytes));
  }
  if (!options.join.empty()) validate_join(options);
}

/// The volume, and the depths that it is made for.
void complete_volume(Options& options) {
  auto& volume = options.pipeline.volume;
  if (options.resolution_m == 0.0) options.resolution_m = volume.resolution_m;
  volume.resolution_m = options.resolution_m;
  // What follows from it would have the wrong value and be named instead.
  require(volume.resolution_m > 0.0, "--resolution", volume.resolution_m, "greater than 0");
  if (options.volume.empty()) options.volume = options.volume_size_m == 0.0 ? "range" : "cube";
  if (options.volume == "range" && options.volume_size_m != 0.0) {
    throw std::invalid_argument("--volume-size is for --volume cube, --volume is 'range'");
  }
  if (options.volume_size_m == 0.0) options.volume_size_m = volume.volume_size_m;
  volume.volume_size_m = options.volume_size_m;
  if (options.volume == "cube") {
    volume.region = RegionShape::kCube;
    if (options.max_range_m == 0.0) options.max_range_m = kLongestDepth_m;
  } else if (options.volume == "range") {
    options.pipeline.set_max_range(options.max_range_m);
    options.max_range_m = volume.max_range_m;
  } else {
    throw std::invalid_argument("--volume is '" + options.volume + "', must be range or cube");
  }
  options.source.max_range_m = options.max_range_m;
}

/// How the map is handed out.
void complete_slices(Options& options) {
  if (options.slices != "patch" && options.slices != "shift") {
    throw std::invalid_argument("--slices is '" + options.slices + "', must be patch or shift");
  }
  options.pipeline.close_loops = !options.no_loop_closure;
  options.pipeline.patch_side_m = options.slices == "patch" ? kUsualPatchSide_m : 0.0;
}

/// The noise that --depth-noise gives.
/// @throws std::invalid_argument naming the flag, its value and what was expected
DepthNoise parse_depth_noise(const std::string& text) {
  DepthNoise noise;
  std::istringstream in(text);
  char comma_1 = 0;
  char comma_2 = 0;
  in >> noise.base_m >> comma_1 >> noise.share >> comma_2 >> noise.growth_per_m;
  const bool is_complete = in && comma_1 == ',' && comma_2 == ',' && (in >> std::ws).eof();
  const bool is_noise = noise.base_m > 0.0 && noise.base_m <= 1.0 && noise.share >= 0.0 &&
                        noise.share <= 1.0 && noise.growth_per_m >= 0.0 &&
                        noise.growth_per_m <= 1.0;
  if (!is_complete || !is_noise) {
    throw std::invalid_argument("--depth-noise is '" + text +
                                "', expected BASE,SHARE,GROWTH with BASE in (0, 1] and the others "
                                "in [0, 1], such as 0.0012,0,0.00165");
  }
  return noise;
}

/// What is known of the noise of depth.
void complete_noise(Options& options) {
  if (!options.sensor.empty() && !options.depth_noise.empty()) {
    throw std::invalid_argument("--sensor and --depth-noise exclude each other");
  }
  if (!options.depth_noise.empty()) {
    options.pipeline.noise = parse_depth_noise(options.depth_noise);
    options.pipeline.learn_noise = false;
  } else if (!options.sensor.empty()) {
    options.pipeline.noise = noise_of_sensor(options.sensor);
    if (!options.pipeline.noise) {
      throw std::invalid_argument("--sensor is '" + options.sensor + "', must be " +
                                  std::string(kSensorNames));
    }
  }
}

/// Checks the flags and sets what follows from them.
void complete(Options& options) {
  complete_noise(options);
  complete_volume(options);
  complete_slices(options);
  options.source.lcm_url = options.lcm_url;
  if (options.lock_exposure_s >= 0.0) {
    options.source.lock_exposure_after_s = options.lock_exposure_s;
  }
  validate(options);
  pass_ground_truth_to_device(options);
  if (!options.given_path_file.empty()) {
    options.pipeline.given_path = read_tum_file(options.given_path_file);
  }
}

}  // namespace

MappingOptions mapping_options(const Options& options) {
  Options copy = options;  // the table points to members that can be written
  MappingOptions values;
  for (const OptionGroup& group : option_table(copy)) {
    for (const MapperOption& option : group.options) {
      if (option.on_resume() == OnResume::kMustMatch) values[option.flag()] = option.value_text();
    }
  }
  return values;
}

std::variant<Options, int> parse_options(int argc, const char* const* argv) {
  Options options;
  CLI::App app{"Maps the RGB-D frames of an OpenNI2 device and publishes the map in slices."};
  add_flags(app, options);
  app.option_defaults()->group("Help and configuration");
  add_version_flag(app);
  add_config_flag(app, "read flags from this file (TOML)");
  bool print_config = false;
  app.add_flag("--print-config", print_config, "print every flag with its value, and exit")
      ->configurable(false);
  bool print_devices = false;
  app.add_flag("--list-devices", print_devices,
               "print the modes of the device, or of every camera, and exit")
      ->configurable(false);
  std::string probed;
  app.add_option("--probe", probed,
                 "print what this recording is, its cameras, its length and what is missing, and "
                 "exit")
      ->configurable(false);
  bool check_only = false;
  app.add_flag("--check", check_only,
               "check the flags, open the device (not with --resume, which may need none), and "
               "exit: 0 if all is well, or with the reason")
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
  if (!probed.empty()) {
    std::cout << probe_recording(probed);
    return 0;
  }
  const std::string device = options.source.device;
  complete(options);
  if (check_only) {
    options.source.device = device;  // without --ground-truth, which would be written
    if (options.resume_file.empty()) open_frame_source(options.source);
    return 0;
  }
  return options;
}

}  // namespace kintsugi::mapper
