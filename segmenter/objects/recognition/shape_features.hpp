#pragma once
// Descriptors of the shape of a surface around each of its points.

#include <Eigen/Core>

#include "segmenter/objects/recognition/surface.hpp"

namespace kintsugi::segmenter {

inline constexpr int kShapeFeatureSize = 33;

using ShapeFeature = Eigen::Matrix<float, kShapeFeatureSize, 1>;
/// A column for each point, in order.
using ShapeFeatures = Eigen::Matrix<float, kShapeFeatureSize, Eigen::Dynamic>;

/// Fast Point Feature Histograms (Rusu, Blodow, Beetz, "Fast Point Feature Histograms for 3D
/// registration", ICRA 2009) as PCL computes them, from the points within `radius_m`. Each of the
/// three histograms of a point is scaled to the sum 1, and of each bin the root is taken, so that
/// Euclidean distances are Hellinger distances. Zero for a point without neighbours.
ShapeFeatures shape_features(const Surface& surface, float radius_m);

}  // namespace kintsugi::segmenter
