#include "segmenter/evaluation/report/figure.hpp"

#include <algorithm>
#include <exception>

#include "lcmtypes/base/logger.hpp"
#include "segmenter/evaluation/report/text_file.hpp"

namespace kintsugi::segmenter {
namespace {

/// The figure as SVG; "" when gnuplot cannot draw it.
std::string draw(const Figure& figure, bool has_gnuplot, const std::filesystem::path& folder) {
  const auto script = folder / (figure.name + ".gp");
  write_text_file(script, to_gnuplot(figure.plot));
  std::string svg;
  try {
    if (has_gnuplot) svg = run_gnuplot(script);
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
  }
  if (!svg.empty()) write_text_file(folder / (figure.name + ".svg"), svg);
  return svg;
}

}  // namespace

std::vector<DrawnFigure> draw_figures(const std::vector<Figure>& figures, bool has_gnuplot,
                                      const std::filesystem::path& folder) {
  std::vector<DrawnFigure> drawn;
  drawn.reserve(figures.size());
  for (const Figure& figure : figures) {
    drawn.push_back({figure.title, figure.caption, draw(figure, has_gnuplot, folder)});
  }
  return drawn;
}

bool are_drawn(const std::vector<DrawnFigure>& figures) {
  return std::ranges::none_of(figures,
                              [](const DrawnFigure& figure) { return figure.svg.empty(); });
}

}  // namespace kintsugi::segmenter
