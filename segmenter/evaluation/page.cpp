#include "segmenter/evaluation/page.hpp"

#include <fstream>
#include <thread>
#include <utility>

#include "segmenter/evaluation/result_tables.hpp"
#include "segmenter/evaluation/table.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr char kStyle[] = R"(
body { font: 16px/1.5 sans-serif; color: #222; background: #fff; max-width: 60rem;
       margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.6rem; } h2 { font-size: 1.2rem; margin-top: 2.2rem; }
table { border-collapse: collapse; font-size: .92rem; }
th, td { padding: .25rem .8rem .25rem 0; border-bottom: 1px solid #e0e0e0; text-align: right;
         vertical-align: top; }
th:first-child, td:first-child { text-align: left; }
dl { display: grid; grid-template-columns: max-content auto; gap: .1rem 1.2rem; }
dt { color: #666; } dd { margin: 0; overflow-wrap: anywhere; }
.note, figcaption { color: #555; font-size: .92rem; } .remark { color: #a04000; }
figure { margin: 1rem 0 2rem; } svg { width: 100%; height: auto; }
.wide { overflow-x: auto; }
)";

std::string section(const std::string& title) { return "<h2>" + html_escaped(title) + "</h2>\n"; }

std::string note(const std::string& text) {
  return "<p class=\"note\">" + html_escaped(text) + "</p>\n";
}

std::string wide(const Table& table) {
  return "<div class=\"wide\">\n" + to_html(table) + "</div>\n";
}

using Facts = std::vector<std::pair<std::string, std::string>>;

std::string list(const Facts& facts) {
  std::string text = "<dl>\n";
  for (const auto& [name, value] : facts) {
    text += "<dt>" + html_escaped(name) + "</dt><dd>" + html_escaped(value) + "</dd>\n";
  }
  return text + "</dl>\n";
}

std::string megabytes(std::int64_t bytes) {
  return decimal(static_cast<double>(bytes) / 1e6, 0) + " MB";
}

std::string processor() {
  std::ifstream cpuinfo("/proc/cpuinfo");
  for (std::string line; std::getline(cpuinfo, line);) {
    if (line.rfind("model name", 0) != 0) continue;
    const auto colon = line.find(": ");
    if (colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown processor";
}

std::string session_facts(const Evaluation& evaluation) {
  const RecordedSession& session = evaluation.session;
  Facts facts{{"Source", session.source},
              {"Slices", grouped(session.num_slices)},
              {"Points", grouped(evaluation.num_vertices)},
              {"Resolution", decimal(1e3 * evaluation.config.engine.resolution_m, 3) + " mm"},
              {"Segments (batch)", grouped(evaluation.num_segments)}};
  if (const auto num_rejected = session.num_points() - evaluation.num_vertices; num_rejected > 0) {
    facts.emplace_back("Points rejected", grouped(num_rejected));
  }
  std::string text = list(facts);
  for (const std::string& remark : session.remarks) {
    text += "<p class=\"remark\">" + html_escaped(remark) + "</p>\n";
  }
  return text;
}

std::string sampling_note(const Evaluation& evaluation) {
  for (const ModeResult& mode : evaluation.modes) {
    if (mode.is_complete) continue;
    return note("~ Batch ran after every " + std::to_string(evaluation.batch_every) +
                " slices and after the last only (--batch-every 1 runs it after each): average "
                "and total are estimated, the other figures are of the runs.");
  }
  return "";
}

std::string tables(const Evaluation& evaluation) {
  std::string text = section("Table I: computational performance");
  text += wide(readable_table1(evaluation)) + sampling_note(evaluation);
  text += note(
      "Times are wall time of the segmentation of a slice, without keeping the segment "
      "ids, which has its own row. Batch starts from nothing each time. Memory growth is "
      "that of the process over the replay, the points themselves included. The paper's "
      "datasets are others: its columns are no comparison of equals.");
  text += section("Table II: lag");
  if (evaluation.session.has_times) {
    text += wide(readable_table2(evaluation));
    text += note(
        "Simulated: a slice is ready at its own time and waits until those before it are "
        "segmented, each in its measured time. Counted when a slice is ready.");
  } else {
    text += note("Left out: the slices have no times.");
  }
  text += section("Agreement with batch on the final map (Eq. 5)");
  text += wide(readable_agreement(evaluation));
  text += note(
      "v is the mutual overlap of a segment with the best one of batch; 1: the very same "
      "points. The count of segments hides that a few large ones hold most points.");
  return text;
}

std::string plots(const std::vector<DrawnFigure>& figures) {
  std::string text;
  for (const DrawnFigure& figure : figures) {
    text += section(figure.title) + "<figure>\n";
    // gnuplot's own header is for a file by itself.
    const auto start = figure.svg.find("<svg");
    text += start == std::string::npos
                ? "<p class=\"remark\">Not drawn: gnuplot is missing or failed. It is in the "
                  "Debian package gnuplot-nox.</p>\n"
                : figure.svg.substr(start) + "\n";
    text += "<figcaption>" + html_escaped(figure.caption) + "</figcaption>\n</figure>\n";
  }
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
  return section("Parameters") +
         list({{"T (threshold)", decimal(engine.threshold, 6)},
               {"k (scale)", decimal(engine.scale, 6)},
               {"beta (voting)", decimal(engine.beta, 3)},
               {"r (radius)", decimal(1e3 * engine.radius_m(), 3) + " mm"},
               {"Neighbour search",
                engine.neighbour_search == NeighbourSearch::kGrid ? "grid" : "flann"},
               {"Batch after every", std::to_string(evaluation.batch_every) + " slices"},
               {"Batch once, final map", decimal(evaluation.batch_final_ms, 1) + " ms"},
               {"Segments of Fig. 2", list_of_segments(evaluation)},
               {"Command line", context.command_line},
               {"Version", context.version},
               {"gnuplot", context.gnuplot_version.value_or("missing")},
               {"Machine", processor() + ", " +
                               std::to_string(std::thread::hardware_concurrency()) + " threads"},
               {"Memory at the end", megabytes(evaluation.resident_bytes)},
               {"Memory at most", megabytes(evaluation.peak_resident_bytes)}});
}

}  // namespace

std::string make_page(const Evaluation& evaluation, const ReportContext& context,
                      const std::vector<DrawnFigure>& figures) {
  const std::string title =
      "Evaluation of " + html_escaped(std::filesystem::path(evaluation.session.source).filename());
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>" + title +
         "</title>\n<style>" + kStyle + "</style>\n</head>\n<body>\n<h1>" + title + "</h1>\n" +
         session_facts(evaluation) + tables(evaluation) + plots(figures) +
         parameters(evaluation, context) +
         "<p class=\"note\">The paper: R. Finman, T. Whelan, L. Paull, J. J. Leonard, Efficient "
         "Incremental Map Segmentation in Dense RGB-D Maps, ICRA 2014.</p>\n</body>\n</html>\n";
}

}  // namespace kintsugi::segmenter
