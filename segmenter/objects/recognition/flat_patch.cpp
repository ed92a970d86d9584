#include "segmenter/objects/recognition/flat_patch.hpp"

#include <Eigen/Eigenvalues>

#include "segmenter/objects/recognition/agreement.hpp"

namespace kintsugi::segmenter {

namespace {

// The normals of a flat patch deviate less than this from their axis: sine of 15 degrees. Along its
// rim they are between those of two faces: 45 degrees in the outermost points are a root mean
// square of 11 degrees in a face 25 points wide, and of 15 in one 15 points wide.
constexpr double kFlat = 0.26;
// And the colours of a plain one from their mean (CIELAB), by shades and noise.
constexpr double kPlain = kSameColor / 3;

}  // namespace

bool is_flat(const SurfaceMoments& moments) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(moments.squared_normals,
                                                            Eigen::EigenvaluesOnly);
  return axes.eigenvalues()[1] < kFlat * kFlat * moments.points;
}

bool is_plain(const SurfaceMoments& moments) {
  return moments.lab_variance().sum() < kPlain * kPlain;
}

bool is_flat_patch(const SurfaceMoments& moments) { return is_flat(moments) && is_plain(moments); }

}  // namespace kintsugi::segmenter
