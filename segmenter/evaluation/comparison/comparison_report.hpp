#pragma once
// The results of a comparison as files.

#include <filesystem>

#include "segmenter/evaluation/comparison/comparison.hpp"
#include "segmenter/evaluation/report/page_parts.hpp"

namespace kintsugi::segmenter {

/// Writes into `folder`, which exists: quality.csv, instances.csv, of each figure NAME.gp and
/// NAME.svg, and a self-contained index.html. Returns false when figures are missing because
/// gnuplot is not installed.
/// @throws std::system_error naming the file that could not be written
bool write_comparison_report(const Comparison& comparison, const ReportContext& context,
                             const std::filesystem::path& folder);

}  // namespace kintsugi::segmenter
