#pragma once
// kintsugi-evaluate: the tables and figures of the paper over one recorded map.

#include <filesystem>

#include "segmenter/evaluation/paper/evaluation.hpp"
#include "segmenter/evaluation/report/page_parts.hpp"

namespace kintsugi::segmenter {

/// Evaluates the session and writes the report into `folder` (write_report()); logs progress and
/// results. Returns false when figures are missing for want of gnuplot.
/// @throws std::system_error naming the file that could not be written
bool report_paper(RecordedSession session, const EvaluationConfig& config,
                  const ReportContext& context, const std::filesystem::path& folder);

}  // namespace kintsugi::segmenter
