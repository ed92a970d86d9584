#pragma once
// kintsugi-evaluate --ground-truth: how good segments are where the true instances are known.

#include <filesystem>
#include <string>

#include "segmenter/evaluation/comparison/comparison.hpp"
#include "segmenter/evaluation/report/page_parts.hpp"

namespace CLI {
class App;
}

namespace kintsugi::segmenter {

struct QualityOptions {
  std::string truth_file;  ///< PLY; empty: this task is not asked for
  ComparisonConfig comparison;
};

void add_quality_options(CLI::App& app, QualityOptions& options);

/// Compares parameter sets over the session and writes the report into `folder`
/// (write_comparison_report()); logs each result. Returns false when figures are missing for want
/// of gnuplot.
/// @throws what read_truth(), compare_parameters() and write_comparison_report() throw
bool report_quality(const RecordedSession& session, const QualityOptions& options,
                    const ReportContext& context, const std::filesystem::path& folder);

}  // namespace kintsugi::segmenter
