#include "mapper/core/guests/keyframe_message.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <opencv2/core.hpp>

namespace kintsugi::mapper {
namespace {

/// The coarsest of three levels has 20 columns.
constexpr int kLeastWidth_px = 80;
constexpr int kLeastHeight_px = 60;
/// Keyframes have half of the size at which frames are tracked, which is below 640 columns.
constexpr int kMostWidth_px = 640;
constexpr int kMostHeight_px = 640;

void put_features(const ImageFeatures& features, KeyframeMessage& message) {
  message.features.resize(features.size());
  for (int i = 0; i < features.size(); ++i) {
    KeyframeFeature& put = message.features[i];
    put.ray_x = features.rays_C[i].x;
    put.ray_y = features.rays_C[i].y;
    const float depth_m = features.depths_m[i];
    put.depth_m = depth_m > 0.0F ? depth_m : 0.0F;  // also where it is NaN
    std::memcpy(put.descriptor, features.descriptors.ptr(i), sizeof(put.descriptor));
  }
}

ImageFeatures features_of(const KeyframeMessage& message) {
  ImageFeatures features;
  const int count = static_cast<int>(message.features.size());
  if (count == 0) return features;
  features.descriptors.create(count, static_cast<int>(sizeof(KeyframeFeature::descriptor)));
  for (int i = 0; i < count; ++i) {
    const KeyframeFeature& from = message.features[i];
    features.rays_C.emplace_back(from.ray_x, from.ray_y);
    features.depths_m.push_back(from.depth_m > 0.0F ? from.depth_m
                                                    : std::numeric_limits<float>::quiet_NaN());
    std::memcpy(features.descriptors.ptr(i), from.descriptor, sizeof(from.descriptor));
  }
  return features;
}

}  // namespace

KeyframeMessage keyframe_message(const NewKeyframe& added, std::optional<int> previous, int part,
                                 std::int64_t utime, double resolution_m) {
  const Keyframe& keyframe = *added.keyframe;
  KeyframeMessage message;
  message.utime = utime;
  message.number = added.number;
  message.previous = previous.value_or(-1);
  message.tracked_from = added.from.value_or(-1);
  message.part = part;
  message.way_m = added.way_m;
  message.unseen_m = added.unseen ? added.unseen->distance_m : 0.0;
  message.resolution_m = static_cast<float>(resolution_m);
  message.X_UK = keyframe.X_WC;
  message.information_K = 0.5 * (added.information + added.information.transpose());
  message.noise_base_m = added.noise.base_m;
  message.noise_share = added.noise.share;
  message.noise_growth_per_m = added.noise.growth_per_m;
  message.intrinsics = keyframe.camera;
  message.intrinsics.distortion = {};
  for (int i = 0; i < added.number; ++i) {
    if (!added.is_released[i]) message.in_volume.push_back(i);
  }
  put_features(keyframe.appearance.features, message);
  message.depth.assign(keyframe.depth_raw.begin(), keyframe.depth_raw.end());
  const cv::Mat_<std::uint8_t>& intensity = keyframe.appearance.intensity;
  if (intensity.size() == keyframe.depth_raw.size()) {
    message.intensity.assign(intensity.begin(), intensity.end());
  }
  return message;
}

std::shared_ptr<Keyframe> keyframe_of(const KeyframeMessage& message) {
  const Intrinsics& camera = message.intrinsics;
  if (camera.width < kLeastWidth_px || camera.height < kLeastHeight_px ||
      camera.width > kMostWidth_px || camera.height > kMostHeight_px) {
    return nullptr;
  }
  auto keyframe = std::make_shared<Keyframe>();
  keyframe->X_WC = message.X_UK;
  keyframe->camera = camera;
  keyframe->depth_raw.create(camera.height, camera.width);
  std::ranges::copy(message.depth, keyframe->depth_raw.begin());
  KeyframeAppearance& appearance = keyframe->appearance;
  appearance.thumbnail_m = thumbnail_of(keyframe->surface().depth_m);
  if (!message.intensity.empty()) {
    appearance.intensity.create(camera.height, camera.width);
    std::ranges::copy(message.intensity, appearance.intensity.begin());
  }
  appearance.features = features_of(message);
  return keyframe;
}

}  // namespace kintsugi::mapper
