#pragma once
// The figures of the paper over the results of an evaluation.

#include <cstdint>
#include <utility>
#include <vector>

#include "segmenter/evaluation/paper/evaluation.hpp"
#include "segmenter/evaluation/report/figure.hpp"

namespace kintsugi::segmenter {

/// Those there are data for: Fig. 5 a and b and a logarithmic view of the same (time per slice),
/// Fig. 4 (cumulative v), Fig. 2 (theta against joins), slices behind.
std::vector<Figure> figures(const Evaluation& evaluation);

/// Fig. 4 at v = 0, 1 / `steps`, ..., 1: the percentage of segments of at least `min_points` points
/// with v_i >= v. Empty when there is no such segment.
std::vector<std::pair<double, double>> cumulative_v(const std::vector<SegmentAgreement>& agreements,
                                                    std::int64_t min_points, int steps = 200);

}  // namespace kintsugi::segmenter
