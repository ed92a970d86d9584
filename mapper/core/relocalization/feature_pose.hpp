#pragma once
// The relative pose of two cameras from shared features.

#include <optional>

#include "mapper/core/relocalization/keyframe_appearance.hpp"

namespace kintsugi::mapper {

/// X_KC, from the features of a frame C and of a keyframe K, whose features have depths: matches
/// the nearest descriptors, then solves for the pose (P3P) in RANSAC, with a fixed seed. Nothing
/// with fewer than 12 inliers (within 3 pixels at a focal length of 525).
std::optional<Pose> pose_from_features(const ImageFeatures& features_K,
                                       const ImageFeatures& features_C);

}  // namespace kintsugi::mapper
