#pragma once
// Where an object could be, so that the surface that is seen is part of its surface.

#include <vector>

#include "segmenter/objects/recognition/pose_hypothesis.hpp"
#include "segmenter/objects/recognition/prepared_model.hpp"

namespace kintsugi::segmenter {

/// Poses in which the object stands upright: a vote of pairs of a seen and a model point with like
/// normals and colours for each turn about `up_W` (a generalised Hough transform: Ballard, 1981).
/// The best `count`, best first, refined, and no two alike.
std::vector<PoseHypothesis> upright_poses(const PreparedModel& model, const Surface& seen_W,
                                          const Eigen::Vector3d& up_W, std::size_t count);

}  // namespace kintsugi::segmenter
