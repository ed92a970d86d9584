#pragma once
// Parts of the HTML pages of reports; the pages are self-contained.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "segmenter/evaluation/report/figure.hpp"
#include "segmenter/evaluation/report/table.hpp"

namespace kintsugi::segmenter {

/// How a report was made.
struct ReportContext {
  std::string command_line;
  std::string preset;                          ///< of the parameters that were not given
  std::string version;                         ///< of the program
  std::optional<std::string> gnuplot_version;  ///< nothing: there is no gnuplot
};

/// Names and values.
using Facts = std::vector<std::pair<std::string, std::string>>;

// These escape their arguments, except `body`, which is HTML.
std::string html_page(const std::string& title, const std::string& body);
std::string html_section(const std::string& title);
std::string html_note(const std::string& text);
std::string html_remark(const std::string& text);
std::string html_list(const Facts& facts);
/// A table that scrolls sideways where the page is narrow.
std::string html_wide(const Table& table);
/// A picture in the page itself, under its title. `png` is a PNG file; empty: nothing.
std::string html_picture(const std::string& title, const std::string& png,
                         const std::string& caption);
/// Each figure under its title; instead of one that could not be drawn, the reason.
std::string html_figures(const std::vector<DrawnFigure>& figures);

/// Command line, version, gnuplot and machine.
Facts facts_of(const ReportContext& context);

}  // namespace kintsugi::segmenter
