#include "mapper/source/open_source.hpp"

#include "mapper/source/bus/lcm_source.hpp"
#include "mapper/source/openni2/openni2_source.hpp"

namespace kintsugi::mapper {

std::unique_ptr<FrameSource> open_frame_source(const SourceConfig& config) {
  config.validate();
  if (config.device.starts_with(kLcmScheme)) return std::make_unique<LcmSource>(config);
  return std::make_unique<OpenNi2Source>(config);
}

}  // namespace kintsugi::mapper
