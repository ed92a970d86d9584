#pragma once
// Compares segments with true instances by the points that they share.

#include <cstdint>
#include <span>
#include <vector>

namespace kintsugi::segmenter {

/// The instance of a point whose true instance is unknown: the point is left out of every score.
inline constexpr std::uint32_t kNoInstance = 0;

/// The points that an instance and a segment share.
struct InstanceOverlap {
  std::uint32_t instance = 0;
  std::uint32_t segment = 0;
  std::int64_t instance_size = 0;  ///< points
  std::int64_t segment_size = 0;   ///< points; those of kNoInstance left out
  std::int64_t shared = 0;         ///< points, > 0

  double iou() const {
    return static_cast<double>(shared) / static_cast<double>(instance_size + segment_size - shared);
  }
};

/// How well an instance is segmented.
struct InstanceScore {
  std::uint32_t instance = 0;
  std::int64_t num_points = 0;
  double best_iou = 0.0;  ///< over all segments; 0 when no segment has a point of it
  std::uint32_t best_segment =
      0;  ///< of equal ones the smallest label; kNoSegment when there is none
};

/// Of all points that have an instance. A point without a segment (kNoSegment) counts for its
/// instance, and as lost: no segment has it.
struct OverlapTable {
  std::vector<InstanceOverlap>
      overlaps;  ///< by ascending instance, then segment; none of kNoSegment
  std::vector<InstanceScore> instances;  ///< ascending
  std::int64_t num_points = 0;
};

/// `instances` and `segments` give a label for each point. Throws std::invalid_argument when the
/// sizes differ.
OverlapTable overlap_table(std::span<const std::uint32_t> instances,
                           std::span<const std::uint32_t> segments);

/// ASA: the share of points that are labelled right when each segment as a whole gets the best
/// label (Liu, Tuzel, Ramalingam, Chellappa: Entropy rate superpixel segmentation, CVPR 2011), in
/// [0, 1]; 0 without points. The corrected under-segmentation error of van den Bergh et al. 2012 is
/// 1 - ASA.
double achievable_accuracy(const OverlapTable& table);

/// UE: over instances G and the segments S that touch them, the sum of min(|S and G|, |S without
/// G|), by the number of points (Neubert and Protzel: Superpixel benchmark and comparison, 2012);
/// 0: no segment leaks. A point that leaks counts once for the instance it leaks from and once for
/// the one it leaks into: UE is at most 2 (1 - ASA), and that where in each segment one instance
/// has the majority. Levinshtein's error charges all of a segment that leaks by a single point:
/// with walls of 10^5 points it tells nothing.
double undersegmentation_error(const OverlapTable& table);

}  // namespace kintsugi::segmenter
