#include "mapper/openni2_driver/plugin/offered_modes.hpp"

namespace kintsugi::mapper {
namespace {

using Modes = std::vector<CameraImitation::Mode>;
using DepthFormat = CameraImitation::DepthFormat;

OniPixelFormat pixel_format(DepthFormat format) {
  switch (format) {
    case DepthFormat::k1mm:
      return ONI_PIXEL_FORMAT_DEPTH_1_MM;
    case DepthFormat::k100um:
      return ONI_PIXEL_FORMAT_DEPTH_100_UM;
    case DepthFormat::kShift:
      break;
  }
  return ONI_PIXEL_FORMAT_SHIFT_9_2;
}

/// The recording's own units: the common one first.
std::vector<DepthFormat> units_of(const Recording& recording) {
  if (recording.finest_depth_unit() == DepthUnit::k1mm) return {DepthFormat::k1mm};
  return {DepthFormat::k1mm, DepthFormat::k100um};
}

Modes or_own(const Modes& modes, const Recording& recording) {
  if (!modes.empty()) return modes;
  return {{.width = recording.intrinsics().width,
           .height = recording.intrinsics().height,
           .rate_hz = recording.frame_rate_hz()}};
}

OniVideoMode video_mode(const CameraImitation::Mode& mode, OniPixelFormat format) {
  return {.pixelFormat = format,
          .resolutionX = mode.width,
          .resolutionY = mode.height,
          .fps = mode.rate_hz};
}

}  // namespace

std::vector<OniVideoMode> offered_depth_modes(const Recording& recording,
                                              const CameraImitation& imitation) {
  std::vector<OniVideoMode> offered;
  if (!imitation.depth) return offered;
  const auto units = imitation.depth_units.empty() ? units_of(recording) : imitation.depth_units;
  for (const auto& mode : or_own(imitation.depth_modes, recording)) {
    for (const DepthFormat unit : units) offered.push_back(video_mode(mode, pixel_format(unit)));
  }
  return offered;
}

std::vector<OniVideoMode> offered_color_modes(const Recording& recording,
                                              const CameraImitation& imitation) {
  std::vector<OniVideoMode> offered;
  if (!imitation.color || recording.num_color_frames() == 0) return offered;
  for (const auto& mode : or_own(imitation.color_modes, recording)) {
    offered.push_back(video_mode(mode, ONI_PIXEL_FORMAT_RGB888));
  }
  return offered;
}

}  // namespace kintsugi::mapper
