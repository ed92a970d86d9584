#include "segmenter/evaluation/report.hpp"

#include <exception>
#include <vector>

#include <spdlog/spdlog.h>

#include "lcmtypes/atomic_file.hpp"
#include "segmenter/evaluation/page.hpp"
#include "segmenter/evaluation/result_plots.hpp"
#include "segmenter/evaluation/result_tables.hpp"

namespace kintsugi::segmenter {
namespace {

void write_file(const std::filesystem::path& path, const std::string& text) {
  AtomicFile file(path);
  file.stream() << text;
  file.commit();
}

void write_tables(const Evaluation& evaluation, const std::filesystem::path& folder) {
  write_file(folder / "table1.csv", to_csv(table1(evaluation)));
  if (evaluation.session.has_times) write_file(folder / "table2.csv", to_csv(table2(evaluation)));
  write_file(folder / "agreement.csv", to_csv(agreement_table(evaluation)));
  write_file(folder / "theta.csv", to_csv(theta_table(evaluation)));
  for (const ModeResult& mode : evaluation.modes) {
    write_file(folder / ("slices_" + mode.replay.mode + ".csv"),
               to_csv(slices_table(evaluation, mode)));
  }
}

/// The figure as SVG; "" when gnuplot cannot draw it.
std::string draw(const Figure& figure, bool has_gnuplot, const std::filesystem::path& folder) {
  const auto script = folder / (figure.name + ".gp");
  write_file(script, to_gnuplot(figure.plot));
  std::string svg;
  try {
    if (has_gnuplot) svg = run_gnuplot(script);
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
  }
  if (!svg.empty()) write_file(folder / (figure.name + ".svg"), svg);
  return svg;
}

}  // namespace

bool write_report(const Evaluation& evaluation, const ReportContext& context,
                  const std::filesystem::path& folder) {
  write_tables(evaluation, folder);
  std::vector<DrawnFigure> drawn;
  bool all_drawn = true;
  for (const Figure& figure : figures(evaluation)) {
    drawn.push_back(
        {figure.title, figure.caption, draw(figure, context.gnuplot_version.has_value(), folder)});
    all_drawn = all_drawn && !drawn.back().svg.empty();
  }
  write_file(folder / "index.html", make_page(evaluation, context, drawn));
  return all_drawn;
}

}  // namespace kintsugi::segmenter
