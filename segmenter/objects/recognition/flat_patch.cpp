#include "segmenter/objects/recognition/flat_patch.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cstddef>

#include "segmenter/objects/recognition/agreement.hpp"

namespace kintsugi::segmenter {

namespace {

// The normals of a flat patch deviate less than this from their axis: sine of 15 degrees. Along its
// rim they are between those of two faces: 45 degrees in the outermost points are a root mean
// square of 11 degrees in a face 25 points wide, and of 15 in one 15 points wide.
constexpr float kFlat = 0.26F;
// And the colours of a plain one from their mean (CIELAB), by shades and noise.
constexpr float kPlain = kSameColor / 3;

}  // namespace

bool is_flat(const Surface& surface) {
  Eigen::Matrix3f sum = Eigen::Matrix3f::Zero();
  for (const SurfacePoint& point : surface) sum += point.normal * point.normal.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> axes(sum, Eigen::EigenvaluesOnly);
  return axes.eigenvalues()[1] < kFlat * kFlat * static_cast<float>(surface.size());
}

bool is_plain(const Surface& surface) {
  const auto count = static_cast<float>(
      std::max(std::ptrdiff_t{1}, std::ranges::count_if(surface, &SurfacePoint::has_color)));
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  for (const SurfacePoint& point : surface) {
    if (point.has_color) mean += point.lab / count;
  }
  float squares = 0.0F;
  for (const SurfacePoint& point : surface) {
    if (point.has_color) squares += (point.lab - mean).squaredNorm();
  }
  return squares < kPlain * kPlain * count;
}

}  // namespace kintsugi::segmenter
