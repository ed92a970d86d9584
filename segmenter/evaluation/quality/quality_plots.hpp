#pragma once
// The quality of segmentations as figures.

#include <vector>

#include "segmenter/evaluation/quality/quality_evaluation.hpp"
#include "segmenter/evaluation/report/figure.hpp"

namespace kintsugi::segmenter {

/// Objects found against the IoU asked for, of each preset; and, where there is a sweep, mean best
/// IoU, ASA and points in large segments against each parameter.
std::vector<Figure> quality_figures(const QualityEvaluation& evaluation);

}  // namespace kintsugi::segmenter
