#pragma once
// kintsugi-evaluate --ground-truth: how good segments are where the truth is known.

#include <string>

#include "segmenter/evaluation/quality/quality_evaluation.hpp"

namespace CLI {
class App;
}

namespace kintsugi::segmenter {

struct QualityOptions {
  std::string truth_file;  ///< PLY; empty: nothing is to be done
  QualityEvaluationConfig evaluation;
};

void add_quality_options(CLI::App& app, QualityOptions& options);

/// evaluate_quality(), with a line of the log for each result.
QualityEvaluation evaluate_quality_logged(const RecordedSession& session,
                                          const QualityOptions& options);

}  // namespace kintsugi::segmenter
