#include "segmenter/evaluation/paper/report.hpp"

#include "segmenter/evaluation/paper/page.hpp"
#include "segmenter/evaluation/paper/result_plots.hpp"
#include "segmenter/evaluation/paper/result_tables.hpp"
#include "segmenter/evaluation/report/map_picture.hpp"
#include "segmenter/evaluation/report/text_file.hpp"

namespace kintsugi::segmenter {
namespace {

void write_tables(const Evaluation& evaluation, const std::filesystem::path& folder) {
  write_text_file(folder / "table1.csv", to_csv(table1(evaluation)));
  if (evaluation.session.has_times)
    write_text_file(folder / "table2.csv", to_csv(table2(evaluation)));
  write_text_file(folder / "agreement.csv", to_csv(agreement_table(evaluation)));
  write_text_file(folder / "theta.csv", to_csv(theta_table(evaluation)));
  for (const ModeResult& mode : evaluation.modes) {
    write_text_file(folder / ("slices_" + mode.measured.mode + ".csv"),
                    to_csv(slices_table(evaluation, mode)));
  }
}

std::string draw_map(const Evaluation& evaluation) {
  if (evaluation.labels.empty()) return "";
  const PointCloud cloud = final_cloud(evaluation.session);
  return map_picture_png(cloud.points_W(), evaluation.labels, evaluation.session.resolution_m());
}

}  // namespace

bool write_report(const Evaluation& evaluation, const ReportContext& context,
                  const std::filesystem::path& folder) {
  write_tables(evaluation, folder);
  const auto drawn = draw_figures(figures(evaluation), context.gnuplot_version.has_value(), folder);
  const std::string map_png = draw_map(evaluation);
  if (!map_png.empty()) write_text_file(folder / "map.png", map_png);
  write_text_file(folder / "index.html", make_page(evaluation, context, map_png, drawn));
  return are_drawn(drawn);
}

}  // namespace kintsugi::segmenter
