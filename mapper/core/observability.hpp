#pragma once
// Which directions of the camera's motion does a registration determine?

#include <Eigen/Core>

namespace kintsugi::mapper {

/// Directions of motion: each column a twist (translation in metres, rotation in radians), columns
/// independent; none to six.
using TwistBasis = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;

}  // namespace kintsugi::mapper
