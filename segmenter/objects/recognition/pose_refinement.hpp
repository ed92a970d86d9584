#pragma once
// Moves an object onto the surface that is seen.

#include "segmenter/objects/recognition/pose_hypothesis.hpp"
#include "segmenter/objects/recognition/prepared_model.hpp"

namespace kintsugi::segmenter {

/// Iterated closest points: point to plane, and weakly point to point, where planes leave a
/// direction free; correspondences with unlike normals or colours do not count. Begins within a few
/// spacings.
PoseHypothesis refined_pose(const PreparedModel& model, const Surface& seen_W, const Pose& X_WO);

/// The first steps of the same, after which poses can be compared. Agreement is within as many
/// spacings as the next step would reach.
PoseHypothesis roughly_refined_pose(const PreparedModel& model, const Surface& seen_W,
                                    const Pose& X_WO);
/// The other steps, from a pose that is roughly refined.
PoseHypothesis finely_refined_pose(const PreparedModel& model, const Surface& seen_W,
                                   const Pose& X_WO);

}  // namespace kintsugi::segmenter
