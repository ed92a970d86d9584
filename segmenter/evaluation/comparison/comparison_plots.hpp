#pragma once
// The results of a comparison as figures.

#include <vector>

#include "segmenter/evaluation/comparison/comparison.hpp"
#include "segmenter/evaluation/report/figure.hpp"

namespace kintsugi::segmenter {

/// Objects found against the IoU asked for, of each preset; and, where there is a sweep, mean best
/// IoU, ASA and points in large segments against each parameter.
std::vector<Figure> quality_figures(const Comparison& comparison);

}  // namespace kintsugi::segmenter
