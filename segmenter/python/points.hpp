#pragma once
// What Python gives as points and poses, checked.

#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/python/arrays.hpp"

namespace kintsugi::python {

/// Points as the segmenter wants them. `points` is an array (N,) of POINT, which has everything, or
/// (N, 3) of floats with `normals` (N, 3) of floats or None, and `colors` (N, 3) of uint8 or None.
struct PointsArgument {
  std::vector<CloudPoint> points;
  bool has_normals = false;
};

/// @throws py::type_error for a wrong dtype, std::invalid_argument (ValueError) for a wrong shape
PointsArgument points_argument(const py::handle& points, const py::handle& normals,
                               const py::handle& colors);

/// A 4 x 4 matrix of floats whose last row is 0 0 0 1.
/// @throws as points_argument()
Pose pose_argument(const py::handle& matrix, const char* name);
py::array pose_array(const Pose& pose);

/// Three finite numbers.
/// @throws std::invalid_argument
Eigen::Vector3d vector_argument(const py::handle& numbers, const char* name);

}  // namespace kintsugi::python
