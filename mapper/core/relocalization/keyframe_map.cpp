#include "mapper/core/relocalization/keyframe_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "lcmtypes/base/argument_check.hpp"
#include "lcmtypes/trajectory.hpp"
#include "mapper/core/frame/surface_pyramid.hpp"

namespace kintsugi::mapper {
namespace {

cv::Mat_<std::uint16_t> raw_from(cv::Mat_<float> depth_m) {
  depth_m = depth_m.clone();
  cv::patchNaNs(depth_m, 0.0);
  cv::Mat_<std::uint16_t> raw;
  depth_m.convertTo(raw, CV_16U, Keyframe::kRawPerMetre);  // saturates at 16.4 m
  return raw;
}

/// The numbers with the smallest keys, smallest first; of equal keys the lower number first.
std::vector<int> smallest(std::vector<std::pair<double, int>> keys, int count) {
  const auto end =
      keys.begin() + std::min<std::ptrdiff_t>(count, static_cast<std::ptrdiff_t>(keys.size()));
  std::partial_sort(keys.begin(), end, keys.end());
  std::vector<int> numbers;
  for (auto key = keys.begin(); key != end; ++key) numbers.push_back(key->second);
  return numbers;
}

std::vector<int> without_duplicates(std::vector<int> numbers, const std::vector<int>& more) {
  for (const int number : more) {
    if (std::ranges::find(numbers, number) == numbers.end()) numbers.push_back(number);
  }
  return numbers;
}

}  // namespace

SurfaceMap Keyframe::surface() const {
  cv::Mat_<float> depth_m;
  depth_raw.convertTo(depth_m, CV_32F, 1.0 / kRawPerMetre);
  depth_m.setTo(std::numeric_limits<float>::quiet_NaN(), depth_raw == 0);
  return surface_from_depth(depth_m, camera);
}

void KeyframeMap::Config::validate() const {
  check_range("spacing_m", spacing_m, 1e-3, 100.0);
  check_range("spacing_rad", spacing_rad, 1e-3, 3.2);
  check_range("max_features", max_features, 0, 100'000);
  check_range("max_by_features", max_by_features, 0, 1000);
  check_range("min_shared_features", min_shared_features, 1, 100'000);
  check_range("max_by_depth", max_by_depth, 0, 1000);
}

KeyframeMap::KeyframeMap(const Config& config) : config_((config.validate(), config)) {}

std::optional<int> KeyframeMap::find_near(const Pose& X_WC) const {
  std::optional<int> nearest;
  double least = 1.0;
  for (int i = 0; i < size(); ++i) {
    if (is_released_[i]) continue;
    const double distance = in_spacings(keyframes_[i]->X_WC, X_WC);
    if (!(distance < least)) continue;
    least = distance;
    nearest = i;
  }
  return nearest;
}

double KeyframeMap::in_spacings(const Pose& X_WA, const Pose& X_WB) const {
  const Pose X_AB = X_WA.inverse() * X_WB;
  return std::max(X_AB.translation().norm() / config_.spacing_m,
                  rotation_angle_rad(X_AB) / config_.spacing_rad);
}

void KeyframeMap::release_if(const std::function<bool(const Keyframe&)>& has_left) {
  for (int i = 0; i < size(); ++i) {
    if (!is_released_[i]) is_released_[i] = has_left(*keyframes_[i]);
  }
}

void KeyframeMap::add(const Pose& X_WC, const TrackingInput& frame, const SurfaceMap& surface_C) {
  finish_last();
  keyframes_.push_back(std::make_shared<Keyframe>(
      Keyframe{X_WC, {}, surface_C.intrinsics, raw_from(surface_C.depth_m)}));
  is_released_.push_back(false);
  is_guest_.push_back(false);
  appearance_of_last_ = std::async(
      std::launch::async,
      [frame, max_features = config_.max_features] { return appearance_of(frame, max_features); });
}

void KeyframeMap::add_guest(std::shared_ptr<Keyframe> keyframe) {
  finish_last();
  index_.add(keyframe->appearance.features.descriptors);
  keyframes_.push_back(std::move(keyframe));
  is_released_.push_back(true);
  is_guest_.push_back(true);
}

std::vector<int> KeyframeMap::similar_to(const KeyframeAppearance& appearance,
                                         const std::function<bool(int)>& is_near) {
  finish_last();
  const auto is_own = [this](int number) { return !is_guest_[number]; };
  return without_duplicates(by_features(appearance, is_own), by_depth(appearance, [&](int number) {
                              return is_own(number) && is_near(number);
                            }));
}

std::vector<int> KeyframeMap::similar_to(int number, const std::function<bool(int)>& is_candidate) {
  finish_last();
  const KeyframeAppearance& appearance = keyframes_[number]->appearance;
  return without_duplicates(by_features(appearance, is_candidate),
                            by_depth(appearance, is_candidate));
}

void KeyframeMap::finish_last() {
  if (!appearance_of_last_.valid()) return;
  keyframes_.back()->appearance = appearance_of_last_.get();
  index_.add(keyframes_.back()->appearance.features.descriptors);
}

std::vector<int> KeyframeMap::by_features(const KeyframeAppearance& appearance,
                                          const std::function<bool(int)>& is_candidate) const {
  const std::vector<int> shared = index_.count_matches(appearance.features.descriptors);
  std::vector<std::pair<double, int>> keys;
  for (int i = 0; i < size(); ++i) {
    if (shared[i] >= config_.min_shared_features && is_candidate(i))
      keys.emplace_back(-shared[i], i);
  }
  return smallest(std::move(keys), config_.max_by_features);
}

std::vector<int> KeyframeMap::by_depth(const KeyframeAppearance& appearance,
                                       const std::function<bool(int)>& is_candidate) const {
  std::vector<std::pair<double, int>> keys;
  for (int i = 0; i < size(); ++i) {
    if (!is_candidate(i)) continue;
    const double difference =
        thumbnail_difference(appearance.thumbnail_m, keyframes_[i]->appearance.thumbnail_m);
    if (std::isfinite(difference)) keys.emplace_back(difference, i);
  }
  return smallest(std::move(keys), config_.max_by_depth);
}

}  // namespace kintsugi::mapper
