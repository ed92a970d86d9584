#pragma once
// Agreement of two partitions of the same points (Eq. 5 of the paper).

#include <cstdint>
#include <span>
#include <vector>

namespace kintsugi::segmenter {

/// How well one segment is found again in a reference partition.
struct SegmentAgreement {
  std::uint32_t label = 0;
  std::int64_t num_points = 0;
  double v = 0.0;  ///< Eq. 5, in (0, 1]; 1: the very same points
};

/// v_i (Eq. 5) of each segment i of the partition `labels` against the partition `reference`:
/// the maximum over segments g of min(|i and g| / |i|, |i and g| / |g|). Both give a label for each
/// point, any values. By ascending label. Throws std::invalid_argument when the sizes differ.
std::vector<SegmentAgreement> mutual_overlap(std::span<const std::uint32_t> labels,
                                             std::span<const std::uint32_t> reference);

/// All zero when there is no segment.
struct AgreementSummary {
  std::int64_t num_segments = 0;
  std::int64_t num_points = 0;
  double exact_share = 0.0;        ///< of segments, v = 1
  double exact_point_share = 0.0;  ///< of points, in segments with v = 1
  double mean_v = 0.0;             ///< over segments
  double point_mean_v = 0.0;       ///< over points
};

/// Over the segments of at least `min_points` points.
AgreementSummary summarize(std::span<const SegmentAgreement> agreements,
                           std::int64_t min_points = 1);

}  // namespace kintsugi::segmenter
