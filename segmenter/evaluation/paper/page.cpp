#include "segmenter/evaluation/paper/page.hpp"

#include <filesystem>
#include <optional>
#include <utility>

#include "segmenter/evaluation/paper/result_tables.hpp"
#include "segmenter/evaluation/report/page_parts.hpp"
#include "segmenter/evaluation/report/table.hpp"

namespace kintsugi::segmenter {
namespace {

std::string megabytes(std::int64_t bytes) {
  return decimal(static_cast<double>(bytes) / 1e6, 0) + " MB";
}

std::string session_facts(const Evaluation& evaluation, const ReportContext& context) {
  const RecordedSession& session = evaluation.session;
  Facts facts{{"Source", session.source},
              {"Slices", grouped(session.num_slices)},
              {"Points", grouped(evaluation.num_vertices)},
              {"Resolution", decimal(1e3 * evaluation.config.engine.resolution_m, 3) + " mm"},
              {"Segments (batch)", grouped(evaluation.num_segments)}};
  if (const auto num_rejected = session.num_points() - evaluation.num_vertices; num_rejected > 0) {
    facts.emplace_back("Points rejected", grouped(num_rejected));
  }
  std::string text = html_list(facts);
  for (const std::string& remark : session.remarks) text += html_remark(remark);
  const std::string on_run = remark_on_run(evaluation, context);
  return on_run.empty() ? text : text + html_remark(on_run);
}

std::string sampling_note(const Evaluation& evaluation) {
  for (const ModeResult& mode : evaluation.modes) {
    if (mode.is_complete) continue;
    return html_note(
        "~ Batch ran after every " + std::to_string(evaluation.batch_every) +
        " slices and after the last only (--batch-every 1 runs it after each): average "
        "and total are estimated, the other figures are of the runs.");
  }
  return "";
}

std::string tables(const Evaluation& evaluation) {
  std::string text = html_section("Table I: computational performance");
  text += html_wide(readable_table1(evaluation)) + sampling_note(evaluation);
  text += html_note(
      "Times are wall time of the segmentation of a slice, without keeping the segment "
      "ids, which has its own row. Batch starts from nothing each time. Memory growth is "
      "that of the process over the session, the points themselves included. The paper's "
      "datasets are others: its columns are no comparison of equals.");
  text += html_section("Table II: lag");
  if (evaluation.session.has_times) {
    text += html_wide(readable_table2(evaluation));
    text += html_note(
        "Simulated: a slice is ready at its own time and waits until those before it are "
        "segmented, each in its measured time. Counted when a slice is ready.");
  } else {
    text += html_note("Left out: the slices have no times.");
  }
  text += html_section("Agreement with batch on the final map (Eq. 5)");
  text += html_wide(readable_agreement(evaluation));
  text += html_note(
      "v is the mutual overlap of a segment with the best one of batch; 1: the very same "
      "points. The count of segments hides that a few large ones hold most points.");
  return text;
}

std::string list_of_segments(const Evaluation& evaluation) {
  std::string text;
  for (const int rank : evaluation.config.segments) {
    text.append(text.empty() ? "" : ", ").append(std::to_string(rank));
  }
  return text.empty() ? "none" : text;
}

std::string parameters(const Evaluation& evaluation, const ReportContext& context) {
  const EngineConfig& engine = evaluation.config.engine;
  Facts facts{{"Preset", context.preset + ", as far as parameters were not given"},
              {"T (threshold)", decimal(engine.threshold, 6)},
              {"k (scale)", decimal(engine.scale, 6)},
              {"beta (voting)", decimal(engine.beta, 3)},
              {"r (radius)", decimal(1e3 * engine.radius_m(), 3) + " mm"},
              {"Neighbour search", std::string(name_of(engine.neighbour_search))},
              {"Batch after every", std::to_string(evaluation.batch_every) + " slices"},
              {"Batch once, final map", decimal(evaluation.batch_final_ms, 1) + " ms"},
              {"Segments of Fig. 2", list_of_segments(evaluation)}};
  for (auto& fact : facts_of(context)) facts.push_back(std::move(fact));
  facts.emplace_back("Memory at the end", megabytes(evaluation.resident_bytes));
  facts.emplace_back("Memory at most", megabytes(evaluation.peak_resident_bytes));
  return html_section("Parameters") + html_list(facts);
}

}  // namespace

std::string remark_on_run(const Evaluation& evaluation, const ReportContext& context) {
  const std::optional<std::int64_t> of_run = evaluation.session.segments_of_run;
  if (!of_run || *of_run == evaluation.num_segments) return "";
  return "The segmenter of the recorded run ended with " + grouped(*of_run) +
         " segments, batch has " + grouped(evaluation.num_segments) +
         " here: the run had other parameters or another mode. This report is made with preset " +
         context.preset + "; --preset objects is the default of runs.";
}

std::string make_page(const Evaluation& evaluation, const ReportContext& context,
                      const std::string& map_png, const std::vector<DrawnFigure>& figures) {
  const std::string source = std::filesystem::path(evaluation.session.source).filename();
  return html_page(
      "Evaluation of " + source,
      session_facts(evaluation, context) +
          html_picture("Segments of the final map", map_png,
                       "Batch, preset " + context.preset +
                           ", from obliquely above; surfaces seen from behind are left out.") +
          tables(evaluation) + html_figures(figures) + parameters(evaluation, context) +
          html_note("The paper: R. Finman, T. Whelan, L. Paull, J. J. Leonard, Efficient "
                    "Incremental Map Segmentation in Dense RGB-D Maps, ICRA 2014."));
}

}  // namespace kintsugi::segmenter
