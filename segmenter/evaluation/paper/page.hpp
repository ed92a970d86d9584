#pragma once

#include <string>
#include <vector>

#include "segmenter/evaluation/paper/evaluation.hpp"
#include "segmenter/evaluation/report/figure.hpp"
#include "segmenter/evaluation/report/page_parts.hpp"

namespace kintsugi::segmenter {

/// What a reader must know where the map was segmented otherwise when it was recorded; else empty.
std::string remark_on_run(const Evaluation& evaluation, const ReportContext& context);

/// One self-contained HTML page with all results. `map_png`: a picture of the map; empty: none.
std::string make_page(const Evaluation& evaluation, const ReportContext& context,
                      const std::string& map_png, const std::vector<DrawnFigure>& figures);

}  // namespace kintsugi::segmenter
