#pragma once
// Groups points that have changed into objects.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/objects/changes/changed_points.hpp"

namespace kintsugi::segmenter {

/// Surface of one map that is not in the other, as one thing.
struct ChangeGroup {
  std::vector<std::size_t> points;         ///< indices, ascending
  std::vector<std::uint32_t> segment_ids;  ///< of the segments they are of, ascending
  double share_changed = 0.0;              ///< of its points, those that are certainly changed
  /// Otherwise only a trace of one that may have moved: too small, or of another colour but no
  /// segment of its own, as the ground on which something stood, too, may be.
  bool is_thing = true;
};

/// A segment most of whose points have changed, as far as that is known, is changed as a whole; of
/// another one the changed points alone, as where a thing is of one colour with what it stands on.
/// Segments that meet along an edge are one thing. Left out is what is smaller than kLeastPoints at
/// a voxel of 1 cm, or the same area at another, and what is nowhere wider than three voxels: along
/// the edges of things two maps differ by so much, from where their cameras were.
/// @param segment_ids, changes of each point
std::vector<ChangeGroup> group_changes(std::span<const CloudPoint> points,
                                       std::span<const std::uint32_t> segment_ids,
                                       std::span<const PointChange> changes, double voxel_m);

inline constexpr double kLeastPoints = 50.0;
inline constexpr double kLeastTrace = 15.0;

}  // namespace kintsugi::segmenter
