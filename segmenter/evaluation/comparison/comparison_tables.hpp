#pragma once
// The results of a comparison as tables.

#include "segmenter/evaluation/comparison/comparison.hpp"
#include "segmenter/evaluation/report/table.hpp"

namespace kintsugi::segmenter {

// For programs: plain numbers.
/// One row a result, the presets' first.
Table quality_table(const Comparison& comparison);
/// One row an instance of the truth: its points in the map and, for each preset, the best IoU.
Table instance_table(const Comparison& comparison);

// For people.
Table readable_quality(const std::vector<ComparedResult>& results);
/// Those that count, structure first, then by size.
Table readable_instances(const Comparison& comparison);

}  // namespace kintsugi::segmenter
