#include "segmenter/evaluation/report/page_parts.hpp"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <string_view>
#include <thread>

namespace kintsugi::segmenter {
namespace {

constexpr char kStyle[] = R"(
body { font: 16px/1.5 sans-serif; color: #222; background: #fff; max-width: 60rem;
       margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.6rem; } h2 { font-size: 1.2rem; margin-top: 2.2rem; }
table { border-collapse: collapse; font-size: .92rem; }
th, td { padding: .25rem .8rem .25rem 0; border-bottom: 1px solid #e0e0e0; text-align: right;
         vertical-align: top; }
th:first-child, td:first-child { text-align: left; }
dl { display: grid; grid-template-columns: max-content auto; gap: .1rem 1.2rem; }
dt { color: #666; } dd { margin: 0; overflow-wrap: anywhere; }
.note, figcaption { color: #555; font-size: .92rem; } .remark { color: #a04000; }
figure { margin: 1rem 0 2rem; } svg, img { width: 100%; height: auto; }
.wide { overflow-x: auto; }
)";

std::string processor() {
  std::ifstream cpuinfo("/proc/cpuinfo");
  for (std::string line; std::getline(cpuinfo, line);) {
    if (line.rfind("model name", 0) != 0) continue;
    const auto colon = line.find(": ");
    if (colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown processor";
}

/// As in RFC 4648.
std::string base64(const std::string& bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t num_bytes = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8U | (k < num_bytes ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= num_bytes ? kDigits[group >> (18U - 6U * k) & 63U] : '=';
    }
  }
  return text;
}

}  // namespace

std::string html_page(const std::string& title, const std::string& body) {
  const std::string escaped = html_escaped(title);
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>" +
         escaped + "</title>\n<style>" + kStyle + "</style>\n</head>\n<body>\n<h1>" + escaped +
         "</h1>\n" + body + "</body>\n</html>\n";
}

std::string html_section(const std::string& title) {
  return "<h2>" + html_escaped(title) + "</h2>\n";
}

std::string html_note(const std::string& text) {
  return "<p class=\"note\">" + html_escaped(text) + "</p>\n";
}

std::string html_remark(const std::string& text) {
  return "<p class=\"remark\">" + html_escaped(text) + "</p>\n";
}

std::string html_list(const Facts& facts) {
  std::string text = "<dl>\n";
  for (const auto& [name, value] : facts) {
    text += "<dt>" + html_escaped(name) + "</dt><dd>" + html_escaped(value) + "</dd>\n";
  }
  return text + "</dl>\n";
}

std::string html_wide(const Table& table) {
  return "<div class=\"wide\">\n" + to_html(table) + "</div>\n";
}

std::string html_picture(const std::string& title, const std::string& png,
                         const std::string& caption) {
  if (png.empty()) return "";
  return html_section(title) + "<figure>\n<img alt=\"" + html_escaped(title) +
         "\" src=\"data:image/png;base64," + base64(png) + "\">\n<figcaption>" +
         html_escaped(caption) + "</figcaption>\n</figure>\n";
}

std::string html_figures(const std::vector<DrawnFigure>& figures) {
  std::string text;
  for (const DrawnFigure& figure : figures) {
    text += html_section(figure.title) + "<figure>\n";
    // Skips the XML header, which belongs only into a separate SVG file.
    const auto start = figure.svg.find("<svg");
    text += start == std::string::npos
                ? html_remark(
                      "Not drawn: gnuplot is missing or failed. It is in the Debian package "
                      "gnuplot-nox.")
                : figure.svg.substr(start) + "\n";
    text += "<figcaption>" + html_escaped(figure.caption) + "</figcaption>\n</figure>\n";
  }
  return text;
}

Facts facts_of(const ReportContext& context) {
  return {{"Command line", context.command_line},
          {"Version", context.version},
          {"gnuplot", context.gnuplot_version.value_or("missing")},
          {"Machine",
           processor() + ", " + std::to_string(std::thread::hardware_concurrency()) + " threads"}};
}

}  // namespace kintsugi::segmenter
