#include "mapper/process/option_table.hpp"

#include <cmath>
#include <type_traits>
#include <utility>

#include <spdlog/fmt/fmt.h>

#include "lcmtypes/base/argument_check.hpp"
#include "mapper/session/mapping_options.hpp"

namespace kintsugi::mapper {
namespace {

using enum OnResume;

OptionGroup source_options(Options& o) {
  return {"Where frames come from",
          {{"--device", &o.source.device, kMustMatch,
            "the path of a recording (mapper/README.md lists the formats), synthetic://NAME, "
            "lcm://CHANNEL or the URI of a camera; empty: the first camera"},
           {"--calibration", &o.source.calibration_file, kMustMatch,
            "camera.txt: fx fy cx cy width height depth_scale [k1 k2 p1 p2 k3]"},
           {"--replay", &o.source.replay, kMayDiffer,
            "map every frame of a recording, as fast as possible"},
           {"--max-range", &o.max_range_m, kMustMatch,
            "depth beyond this is not used; 0: 6.5 m, with --volume range less where depth is too "
            "noisy "
            "for the voxels",
            "m"},
           // It becomes a part of the address of the device.
           {"--ground-truth", &o.ground_truth_dir, kMustMatch,
            "folder into which a synthetic:// device writes its ground truth"},
           {"--max-frames",
            &o.max_frames,
            kMayDiffer,
            "stop after this number of frames; 0: at the end",
            "",
            {0, 1e9}}}};
}

OptionGroup camera_options(Options& o) {
  return {"Cameras",
          {{"--depth-mode", &o.source.depth_mode, kMustMatch,
            "WIDTHxHEIGHT[@HZ]; empty: 640x480@30 where offered, else the nearest"},
           {"--color-mode", &o.source.color_mode, kMustMatch,
            "WIDTHxHEIGHT[@HZ]; empty: as depth where offered, else the nearest that covers depth"},
           {"--assume-registered", &o.source.assume_registered, kMustMatch,
            "use colour as aligned with depth although the device does not say that it is (.oni "
            "files do not)"},
           {"--lock-exposure",
            &o.lock_exposure_s,
            kMustMatch,
            "lock exposure and white balance this long after the first image; -1: never",
            "s",
            {-1, 1e6}},
           {"--device-silence", &o.source.device_silence_s, kMayDiffer,
            "a camera without depth images for this long counts as disconnected", "s"},
           {"--reconnect", &o.source.reconnect_s, kMayDiffer,
            "how long to wait for a disconnected camera; 0: without limit", "s"}}};
}

OptionGroup mapping_group(Options& o) {
  auto& volume = o.pipeline.volume;
  return {"Mapping",
          {{"--volume", &o.volume, kMustMatch,
            "range: all within --max-range of the camera; cube: a cube around the camera; empty: "
            "range, or cube if --volume-size is given"},
           {"--volume-size", &o.volume_size_m, kMustMatch, "side of the cube; 0: 4.5 m", "m"},
           {"--volume-memory", &volume.max_memory_mb, kMustMatch,
            "above this, what has been out of view for longest leaves the volume; with --volume "
            "range",
            "MB"},
           {"--kept-memory", &o.pipeline.max_kept_mb, kMustMatch,
            "what left the volume is kept, and comes back where the camera does; above this, what "
            "left longest ago is forgotten",
            "MB"},
           {"--resolution", &o.resolution_m, kMustMatch,
            "side of a voxel; 0: 8.79 mm (4.5 m / 512)", "m"},
           {"--sensor", &o.sensor, kMustMatch,
            "noise of depth from which the mapper starts to learn it: structured-light, stereo or "
            "phone-lidar; empty: by the size of the image"},
           {"--depth-noise", &o.depth_noise, kMustMatch,
            "noise of depth, not learned: BASE,SHARE,GROWTH for a standard deviation of "
            "sqrt(BASE^2 + (SHARE z)^2 + (GROWTH z^2)^2) at depth z, metres"},
           {"--shift", &volume.shift_vox, kMustMatch,
            "the volume moves when the camera is further than this from its centre", "voxels"},
           {"--slices", &o.slices, kMustMatch,
            "patch: the map comes in patches as soon as the camera sees them, and again when they "
            "have changed; shift: each part once, when it leaves the volume"},
           {"--min-weight", &o.pipeline.slices.extractor.weight_threshold, kMustMatch,
            "surface points need more observations than this"},
           {"--trajectory", &o.given_path_file, kMustMatch,
            "camera path in TUM format; replaces tracking"},
           {"--no-loop-closure", &o.no_loop_closure, kMustMatch,
            "do not correct the map where the camera comes back to a place"},
           {"--restart-after",
            &o.pipeline.restart_after_s,
            kMustMatch,
            "a camera that stays lost for this long begins another part of the map; 0: never",
            "s",
            {0, 1e6}},
           {"--threads",
            &o.threads,
            kMayDiffer,
            "threads of the parallel stages; 0: one per core",
            "",
            {0, 1024}}}};
}

OptionGroup output_options(Options& o) {
  return {"Files to write",
          {{"--output-trajectory", &o.output_path_file, kMayDiffer,
            "the camera path, corrected by the loops that were closed, TUM format"},
           {"--online-trajectory", &o.online_path_file, kMayDiffer,
            "the camera path as it was believed at each frame, TUM format"},
           {"--cloud", &o.cloud_file, kMayDiffer, "the points of every slice, PLY"},
           {"--mesh", &o.mesh_file, kMayDiffer, "the surface as triangles, PLY"},
           {"--timings", &o.timings_file, kMayDiffer,
            "times and tracking result of every frame, CSV"}}};
}

OptionGroup bus_options(Options& o) {
  return {
      kBusGroup,
      {{"--publish-frames", &o.publish_frames, kMayDiffer, "publish RGBD_FRAME, too"},
       {"--view-rate",
        &o.view_rate_hz,
        kMayDiffer,
        "views of the camera for queries by pixel and for the viewer; 0: none",
        "Hz",
        {0, 1000}},
       {"--lcm-url", &o.lcm_url, kMayDiffer, "URL of the LCM bus; empty: LCM's default"},
       {kMapNameOption, &o.map_name, kMustMatch,
        "name of the map; of mappers on one bus each needs its own"},
       {"--join", &o.join, kMustMatch,
        "name of the map of another mapper on the bus, of which this map becomes a part, joined "
        "where both have seen the same place; empty: none"},
       // Resumption compares it with the session in the log.
       {"--session",
        &o.session,
        kMayDiffer,
        "number of this run; 0: from the clock, or that "
        "of the resumed session",
        "",
        {0, 9.2e18}},
       {"--rate",
        &o.rate_mb_s,
        kMayDiffer,
        "upper limit of the data rate of slices",
        "MB/s",
        {0.001, 1e6}}}};
}

OptionGroup store_options(Options& o) {
  return {
      "Resending and resuming",
      {{"--store", &o.store_file, kMayDiffer,
        "LCM log of all published messages, for resending and resuming; empty: a temporary one"},
       {"--resume", &o.resume_file, kMayDiffer,
        "log of an interrupted run, whose last session is continued"},
       {"--store-file-size",
        &o.store_file_size_mb,
        kMayDiffer,
        "the log continues in FILE.1.lcm and so on above this size",
        "MB",
        {1, 1e9}},
       {"--store-limit",
        &o.store_limit_mb,
        kMayDiffer,
        "the files of the log together stay below this: what the map needs no more is removed; 0: "
        "nothing is",
        "MB",
        {0, 1e9}},
       {"--durable", &o.durable, kMayDiffer,
        "with --store or --resume: a power cut takes at most the last second of the log, and "
        "nothing "
        "that was sent of the map"},
       {"--store-frames", &o.store_frames, kMayDiffer,
        "store all frames in the log, lossless, so that the session of a camera can be "
        "resumed"},
       {"--linger", &o.linger_s, kMayDiffer,
        "at the end, stay until there was no request for this long; -1: until a signal", "s"}}};
}

}  // namespace

MapperOption::MapperOption(std::string flag, OptionValue value, OnResume on_resume,
                           std::string help, std::string unit, Bounds bounds)
    : flag_(std::move(flag)),
      value_(value),
      on_resume_(on_resume),
      help_(std::move(help)),
      unit_(std::move(unit)),
      bounds_(bounds) {}

std::string MapperOption::help() const {
  std::string text = help_;
  if (!unit_.empty()) text += ", " + unit_;
  const bool has_bounds = std::isfinite(bounds_.lowest) || std::isfinite(bounds_.highest);
  if (has_bounds) text += fmt::format(" [{:g}, {:g}]", bounds_.lowest, bounds_.highest);
  return text;
}

std::string MapperOption::value_text() const {
  return std::visit([](const auto* value) { return fmt::format("{}", *value); }, value_);
}

void MapperOption::check_bounds() const {
  const auto check = [this](const auto* value) {
    using Value = std::remove_cvref_t<decltype(*value)>;
    if constexpr (std::is_arithmetic_v<Value> && !std::is_same_v<Value, bool>) {
      const auto number = static_cast<double>(*value);
      require(number >= bounds_.lowest && number <= bounds_.highest, flag_, *value,
              fmt::format("within [{:g}, {:g}]", bounds_.lowest, bounds_.highest));
    }
  };
  std::visit(check, value_);
}

std::vector<OptionGroup> option_table(Options& options) {
  return {source_options(options), camera_options(options), mapping_group(options),
          output_options(options), bus_options(options),    store_options(options)};
}

}  // namespace kintsugi::mapper
