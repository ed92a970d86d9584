#pragma once
// The points of a model: evenly spaced, each surface once.

#include <span>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

/// Points whose normals differ by more than 60 degrees are of two surfaces, however near they are.
inline constexpr float kOneSurface = 0.5F;

/// Merges points closer than `reach_m` (> 0) that are of one surface, into one with their mean
/// position, normal and colour by weight, and the sum of their weights. Points that may not be in a
/// map are left out. Ascending by place; the result does not depend on the order of `points`.
std::vector<CloudPoint> merged_points(std::span<const CloudPoint> points, float reach_m);

/// Adds what `more` has of the surface to `points`: where both have it, within `reach_m` (> 0), the
/// points that are there are moved along their normals to the mean of both by weight; other points
/// are added.
/// @return how many were added
std::size_t merge_surface(std::vector<CloudPoint>& points, std::span<const CloudPoint> more,
                          float reach_m);

}  // namespace kintsugi::segmenter
