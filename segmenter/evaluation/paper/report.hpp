#pragma once
// The results of the paper's measurements as files.

#include <filesystem>

#include "segmenter/evaluation/paper/evaluation.hpp"
#include "segmenter/evaluation/report/page_parts.hpp"

namespace kintsugi::segmenter {

/// Writes into `folder`, which exists, each file beside its name and then renamed: table1.csv,
/// table2.csv (with times only), agreement.csv, theta.csv, slices_<mode>.csv, of each figure
/// NAME.gp (a gnuplot script with its data) and NAME.svg, map.png (the segments of batch, from
/// obliquely above), and index.html, which holds all of it and
/// refers to nothing else. Without gnuplot the SVGs are left out and the page says so. Returns
/// false when figures are missing.
/// @throws std::system_error naming the file that could not be written
bool write_report(const Evaluation& evaluation, const ReportContext& context,
                  const std::filesystem::path& folder);

}  // namespace kintsugi::segmenter
