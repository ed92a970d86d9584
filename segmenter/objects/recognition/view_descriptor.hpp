#pragma once
// A short description of a piece of surface as a whole: size, colours, shape. It chooses the
// objects that a piece is compared with.

#include <Eigen/Core>
#include <vector>

#include "segmenter/objects/recognition/shape_features.hpp"
#include "segmenter/objects/recognition/surface.hpp"
#include "segmenter/objects/recognition/surface_moments.hpp"

namespace kintsugi::segmenter {

/// The elements before the shape features, which cost next to nothing.
inline constexpr int kSizeAndColors = 10;

inline constexpr int kViewDescriptorSize = kSizeAndColors + kShapeFeatureSize;

using SizeAndColors = Eigen::Matrix<float, kSizeAndColors, 1>;
using ViewDescriptor = Eigen::Matrix<float, kViewDescriptorSize, 1>;

/// Of a surface of at least one point:
///   0-2    logarithms of the standard deviations of its points along their principal axes, metres,
///          the largest first; a spacing is added before, so that flat things have a finite one
///   3      logarithm of its area, square metres
///   4-9    mean and standard deviation of L, a and b; 0 without colours
///   10-42  the mean of the shape features of its points
/// @param spacing_m of the points
SizeAndColors size_and_colors(const SurfaceMoments& moments, float spacing_m);
/// Some of those points had a colour: black has none.
inline bool has_colors(const SizeAndColors& elements) { return !elements.tail<6>().isZero(0.0F); }
/// @param mean_features of its points, see shape_features()
ViewDescriptor view_descriptor(const SizeAndColors& beginning, const ShapeFeature& mean_features);

/// What can be seen of a surface from each of some directions around it and above it, besides all
/// of it: points that face the direction and that nothing hides. Without those of which fewer than
/// three points can be seen.
/// @return the indices of the points of each view
std::vector<std::vector<std::size_t>> simulated_views(const Surface& surface, float spacing_m);

/// The points and features of a view.
Surface points_of(const Surface& surface, const std::vector<std::size_t>& view);
ShapeFeatures features_of(const ShapeFeatures& features, const std::vector<std::size_t>& view);

}  // namespace kintsugi::segmenter
