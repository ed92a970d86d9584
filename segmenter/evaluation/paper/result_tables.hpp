#pragma once
// The results of an evaluation as tables.

#include <optional>

#include "segmenter/evaluation/paper/evaluation.hpp"
#include "segmenter/evaluation/report/table.hpp"

namespace kintsugi::segmenter {

/// Times of a mode for one slice, and for all.
struct SliceTimes {
  double max_ms = 0.0;
  double min_ms = 0.0;
  double average_ms = 0.0;
  double p99_ms = 0.0;  ///< nearest rank
  double total_s = 0.0;
};

/// Of a mode that ran at least once. Where it was sampled, average and total are over all steps,
/// the time between two runs taken to grow evenly; the others are over the runs.
SliceTimes slice_times(const MeasuredSession& measured);

/// Of a mode that ran at least once.
double mean_over_runs(const MeasuredSession& measured, double MeasuredRun::*value);

/// Segments of at least so many points count as large.
inline constexpr std::int64_t kLargeSegment = 100;

// For programs: plain numbers, one row a mode (agreement: two, by min_points; slices: one a run).
Table table1(const Evaluation& evaluation);
Table table2(const Evaluation& evaluation);
Table agreement_table(const Evaluation& evaluation);
Table slices_table(const Evaluation& evaluation, const ModeResult& mode);
/// One row a join: rank of the segment, number of the join, theta, points.
Table theta_table(const Evaluation& evaluation);

// For people (readable_tables.cpp): one row a quantity, one column a mode, then the paper's
// datasets.
Table readable_table1(const Evaluation& evaluation);
Table readable_table2(const Evaluation& evaluation);
Table readable_agreement(const Evaluation& evaluation);

}  // namespace kintsugi::segmenter
