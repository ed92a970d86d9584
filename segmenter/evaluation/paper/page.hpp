#pragma once

#include <string>
#include <vector>

#include "segmenter/evaluation/paper/evaluation.hpp"
#include "segmenter/evaluation/report/figure.hpp"
#include "segmenter/evaluation/report/page_parts.hpp"

namespace kintsugi::segmenter {

/// One self-contained HTML page with all results.
std::string make_page(const Evaluation& evaluation, const ReportContext& context,
                      const std::vector<DrawnFigure>& figures);

}  // namespace kintsugi::segmenter
