#pragma once
// Figures of a report.

#include <filesystem>
#include <string>
#include <vector>

#include "segmenter/evaluation/report/plot.hpp"

namespace kintsugi::segmenter {

struct Figure {
  std::string name;  ///< of its file: "fig5a"
  std::string title;
  std::string caption;
  Plot plot;
};

/// A figure for the page.
struct DrawnFigure {
  std::string title;
  std::string caption;
  std::string svg;  ///< as gnuplot prints it; empty: it could not be drawn
};

/// Writes NAME.gp of each figure (a gnuplot script with its data) and, where there is gnuplot,
/// NAME.svg. Logs what gnuplot fails on.
/// @throws std::system_error naming the file that could not be written
std::vector<DrawnFigure> draw_figures(const std::vector<Figure>& figures, bool has_gnuplot,
                                      const std::filesystem::path& folder);

/// True when there is a picture of each.
bool are_drawn(const std::vector<DrawnFigure>& figures);

}  // namespace kintsugi::segmenter
