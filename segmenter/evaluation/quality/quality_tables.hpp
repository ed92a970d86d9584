#pragma once
// The quality of segmentations as tables.

#include "segmenter/evaluation/quality/quality_evaluation.hpp"
#include "segmenter/evaluation/report/table.hpp"

namespace kintsugi::segmenter {

// For programs: plain numbers.
/// One row a result, the presets' first.
Table quality_table(const QualityEvaluation& evaluation);
/// One row an instance of the truth: its points in the map and, for each preset, the best IoU.
Table instance_table(const QualityEvaluation& evaluation);

// For people.
Table readable_quality(const std::vector<QualityResult>& results);
/// Those that count, structure first, then by size.
Table readable_instances(const QualityEvaluation& evaluation);

}  // namespace kintsugi::segmenter
