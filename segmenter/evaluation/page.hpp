#pragma once

#include <string>
#include <vector>

#include "segmenter/evaluation/evaluation.hpp"
#include "segmenter/evaluation/report.hpp"

namespace kintsugi::segmenter {

/// A figure for the page.
struct DrawnFigure {
  std::string title;
  std::string caption;
  std::string svg;  ///< as gnuplot prints it; empty: it could not be drawn
};

/// One HTML page with everything in it: it refers to no other file.
std::string make_page(const Evaluation& evaluation, const ReportContext& context,
                      const std::vector<DrawnFigure>& figures);

}  // namespace kintsugi::segmenter
