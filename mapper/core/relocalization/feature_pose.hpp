#pragma once
// The pose between two cameras from features that both see.

#include <optional>

#include "mapper/core/relocalization/place_view.hpp"

namespace kintsugi::mapper {

/// Pose of the camera C of `features_C` in that of the keyframe K, whose features have depths:
/// nearest descriptors, then a pose from points and their images (EPnP) by RANSAC, the same for the
/// same features. Nothing with fewer than 12 features in agreement (3 pixels of 525 focal length).
std::optional<Pose> pose_from_features(const ImageFeatures& features_K,
                                       const ImageFeatures& features_C);

}  // namespace kintsugi::mapper
