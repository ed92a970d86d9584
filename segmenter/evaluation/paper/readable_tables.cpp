#include <functional>
#include <utility>

#include "segmenter/evaluation/paper/paper_results.hpp"
#include "segmenter/evaluation/paper/result_tables.hpp"

namespace kintsugi::segmenter {
namespace {

/// One readable row: a quantity of each mode, then of each of the paper's datasets.
class ReadableRows {
 public:
  ReadableRows(const Evaluation& evaluation, const std::string& quantity) : results_(evaluation) {
    table_.header = {quantity};
    for (const ModeResult& mode : results_.modes) table_.header.push_back(mode.measured.mode);
    for (const paper::Dataset& dataset : paper::kDatasets) {
      table_.header.push_back("paper: " + std::string(dataset.name));
    }
  }

  void add(const std::string& name, const std::function<std::string(const ModeResult&)>& of_mode,
           const std::function<std::string(const paper::Dataset&)>& of_paper) {
    std::vector<std::string>& row = table_.rows.emplace_back();
    row.push_back(name);
    for (const ModeResult& mode : results_.modes) row.push_back(of_mode(mode));
    for (const paper::Dataset& dataset : paper::kDatasets) {
      row.push_back(of_paper ? of_paper(dataset) : "");
    }
  }

  Table take() { return std::move(table_); }

 private:
  const Evaluation& results_;
  Table table_;
};

/// Marks a figure that was not measured after every slice.
std::string sampled(const ModeResult& mode, const std::string& text) {
  return mode.is_complete ? text : "~ " + text;
}

std::string percent(double share) { return decimal(100.0 * share, 1) + " %"; }

}  // namespace

Table readable_table1(const Evaluation& evaluation) {
  const RecordedSession& session = evaluation.session;
  ReadableRows rows(evaluation, "Table I");
  using Mode = const ModeResult&;
  using Paper = const paper::Dataset&;
  rows.add(
      "Vertices", [&](Mode) { return grouped(evaluation.num_vertices); },
      [](Paper p) { return grouped(p.num_vertices); });
  rows.add(
      "Cloud slices", [&](Mode) { return grouped(session.num_slices); },
      [](Paper p) { return grouped(p.num_slices); });
  rows.add(
      "Map build time (s)", [&](Mode) { return decimal(session.build_time_s, 2); },
      [](Paper p) { return decimal(p.build_time_s, 2); });
  rows.add(
      "Map length (m)", [&](Mode) { return decimal(session.path_length_m, 1); },
      [](Paper p) { return decimal(p.length_m, 1); });
  rows.add(
      "Maximum per slice (ms)", [](Mode m) { return decimal(slice_times(m.measured).max_ms, 2); },
      [](Paper p) { return decimal(p.max_ms, 2); });
  rows.add(
      "Minimum per slice (ms)", [](Mode m) { return decimal(slice_times(m.measured).min_ms, 3); },
      [](Paper p) { return decimal(p.min_ms, 2); });
  rows.add(
      "Average per slice (ms)",
      [](Mode m) { return sampled(m, decimal(slice_times(m.measured).average_ms, 2)); },
      [](Paper p) { return decimal(p.average_ms, 2); });
  rows.add(
      "Total timing (s)",
      [](Mode m) { return sampled(m, decimal(slice_times(m.measured).total_s, 2)); },
      [](Paper p) { return decimal(p.total_s, 2); });
  rows.add("99th percentile per slice (ms)",
           [](Mode m) { return decimal(slice_times(m.measured).p99_ms, 2); }, {});
  rows.add(
      "CPU of all threads, average per run (ms)",
      [](Mode m) { return decimal(mean_over_runs(m.measured, &MeasuredRun::engine_cpu_ms), 2); },
      {});
  rows.add("Segment ids, average per slice (ms)",
           [](Mode m) {
             return m.measured.mode == "batch"
                        ? ""
                        : decimal(mean_over_runs(m.measured, &MeasuredRun::ids_ms), 2);
           },
           {});
  rows.add("Memory growth (bytes per point)",
           [&](Mode m) {
             return decimal(static_cast<double>(m.measured.resident_growth_bytes) /
                                static_cast<double>(evaluation.num_vertices),
                            0);
           },
           {});
  return rows.take();
}

Table readable_table2(const Evaluation& evaluation) {
  ReadableRows rows(evaluation, "Table II");
  const auto of_mode = [](auto format) {
    return [format](const ModeResult& mode) -> std::string {
      if (mode.slices_behind.empty()) return "";
      return format(summarize_lag(mode.slices_behind));
    };
  };
  rows.add("Max cloud slices behind",
           of_mode([](const LagSummary& lag) { return grouped(lag.max_slices); }),
           [](const paper::Dataset& p) { return grouped(p.max_slices_behind); });
  rows.add("Average cloud slices behind",
           of_mode([](const LagSummary& lag) { return decimal(lag.mean_slices, 2); }),
           [](const paper::Dataset& p) { return decimal(p.mean_slices_behind, 1); });
  return rows.take();
}

Table readable_agreement(const Evaluation& evaluation) {
  Table table;
  table.header = {"Mode",
                  "Segments of",
                  "Segments",
                  "Points",
                  "v = 1",
                  "Mean v",
                  "Points in segments with v = 1",
                  "Mean v by points"};
  for (const ModeResult& mode : evaluation.modes) {
    for (const std::int64_t min_points : {std::int64_t{1}, kLargeSegment}) {
      const AgreementSummary summary = summarize(mode.agreements, min_points);
      table.rows.push_back(
          {mode.measured.mode,
           min_points == 1 ? "any size" : "at least " + std::to_string(min_points) + " points",
           grouped(summary.num_segments), grouped(summary.num_points), percent(summary.exact_share),
           decimal(summary.mean_v, 4), percent(summary.exact_point_share),
           decimal(summary.point_mean_v, 4)});
    }
  }
  table.rows.push_back({"paper: Two floors", "any size", "", "",
                        decimal(100.0 * paper::kExactShare, 0) + " %", "", "", ""});
  return table;
}

}  // namespace kintsugi::segmenter
