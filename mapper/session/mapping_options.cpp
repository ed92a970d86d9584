#include "mapper/session/mapping_options.hpp"

#include <stdexcept>
#include <string>

#include <spdlog/fmt/fmt.h>

namespace kintsugi::mapper {
namespace {

std::string value_of(const MappingOptions& options, const std::string& name) {
  const auto found = options.find(name);
  return found == options.end() ? "not known" : "'" + found->second + "'";
}

}  // namespace

MappingOptions mapping_options(const Options& options) {
  const SourceConfig& source = options.source;
  const auto& volume = options.pipeline.volume;
  const auto text = [](const auto& value) { return fmt::format("{}", value); };
  return {{kMapNameOption, options.map_name},
          {"--device", source.device},
          {"--calibration", source.calibration_file},
          {"--max-range", text(source.max_range_m)},
          {"--depth-mode", source.depth_mode},
          {"--color-mode", source.color_mode},
          {"--assume-registered", text(source.assume_registered)},
          {"--lock-exposure", text(options.lock_exposure_s)},
          {"--volume-size", text(volume.volume_size_m)},
          {"--resolution", text(volume.resolution_m)},
          {"--shift", text(volume.shift_vox)},
          {"--min-weight", text(options.pipeline.slices.extractor.weight_threshold)},
          {"--trajectory", options.given_path_file}};
}

void expect_same_options(const MappingOptions& now, const MappingOptions& then) {
  std::string differences;
  for (const auto& [name, value] : now) {
    if (value_of(then, name) == value_of(now, name)) continue;
    differences += fmt::format("{}{} is '{}', was {}", differences.empty() ? "" : "; ", name, value,
                               value_of(then, name));
  }
  if (!differences.empty()) {
    throw std::runtime_error("a session is resumed with the options it was begun with: " +
                             differences);
  }
}

}  // namespace kintsugi::mapper
