#pragma once
// What the pages of reports are made of: HTML that refers to no other file.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "segmenter/evaluation/report/figure.hpp"
#include "segmenter/evaluation/report/table.hpp"

namespace kintsugi::segmenter {

/// What a page says of how it came about.
struct ReportContext {
  std::string command_line;
  std::string version;                         ///< of the program
  std::optional<std::string> gnuplot_version;  ///< nothing: there is no gnuplot
};

/// A name and what is said of it.
using Facts = std::vector<std::pair<std::string, std::string>>;

// All of these escape what they are given, but for `body`, which is HTML.
std::string html_page(const std::string& title, const std::string& body);
std::string html_section(const std::string& title);
std::string html_note(const std::string& text);
std::string html_remark(const std::string& text);
std::string html_list(const Facts& facts);
/// A table that scrolls sideways where the page is narrow.
std::string html_wide(const Table& table);
/// Each under its title; one that is not drawn says why.
std::string html_figures(const std::vector<DrawnFigure>& figures);

/// Command line, version, gnuplot and machine.
Facts facts_of(const ReportContext& context);

}  // namespace kintsugi::segmenter
