#include "mapper/source/recorded_poses.hpp"

#include "mapper/openni2_driver/recording/recording_uri.hpp"
#include "mapper/source/openni2/openni2_opening.hpp"

namespace kintsugi::mapper {

Trajectory recorded_poses(const std::string& device) {
  Trajectory poses;
  const auto uri = parse_recording_uri(driver_address(device));
  if (!uri) return poses;
  const auto recording = open_recording(*uri);
  for (int i = 0; i < recording->num_depth_frames(); ++i) {
    const auto X_WC = recording->depth_X_WC(i);
    if (X_WC) poses.push_back({.utime = recording->depth_utime(i), .X_WC = *X_WC});
  }
  return poses;
}

}  // namespace kintsugi::mapper
