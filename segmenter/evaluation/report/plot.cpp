#include "segmenter/evaluation/report/plot.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <sstream>
#include <stdexcept>

namespace kintsugi::segmenter {
namespace {

/// Quoted as one word for the shell.
std::string shell_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted.append(c == '\'' ? "'\\''" : std::string(1, c));
  return quoted + "'";
}

/// Quoted as a string of gnuplot.
std::string gnuplot_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted.append(c == '\'' ? "''" : std::string(1, c));
  return quoted + "'";
}

/// The output of the command; nothing when it cannot be run or fails.
std::optional<std::string> output_of(const std::string& command) {
  FILE* const pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) return std::nullopt;
  std::string output;
  std::array<char, 4096> buffer{};
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    output.append(buffer.data(), count);
  }
  if (::pclose(pipe) != 0) return std::nullopt;
  return output;
}

void write_range(std::ostream& out, char axis,
                 const std::optional<std::pair<double, double>>& range) {
  if (range) out << "set " << axis << "range [" << range->first << ":" << range->second << "]\n";
}

std::string style_of(const Series& series) {
  switch (series.style) {
    case Series::Style::kLine:
      return "lines";
    case Series::Style::kLinesAndPoints:
      return "linespoints pointtype 7 pointsize 0.5";
    case Series::Style::kSteps:
      return "steps";
  }
  return "lines";
}

}  // namespace

std::vector<std::pair<double, double>> thinned(const std::vector<std::pair<double, double>>& points,
                                               std::size_t num_buckets) {
  if (points.size() <= 2 * num_buckets) return points;
  std::vector<std::pair<double, double>> kept;
  for (std::size_t bucket = 0; bucket < num_buckets; ++bucket) {
    const auto first =
        points.begin() + static_cast<std::ptrdiff_t>(bucket * points.size() / num_buckets);
    const auto last =
        points.begin() + static_cast<std::ptrdiff_t>((bucket + 1) * points.size() / num_buckets);
    auto [lowest, highest] = std::minmax_element(
        first, last, [](const auto& a, const auto& b) { return a.second < b.second; });
    if (highest < lowest) std::swap(lowest, highest);
    kept.push_back(*lowest);
    if (lowest != highest) kept.push_back(*highest);
  }
  return kept;
}

std::string to_gnuplot(const Plot& plot) {
  std::ostringstream out;
  out.precision(9);
  out << "set terminal svg size 900,420 dynamic background rgb 'white' font 'sans-serif,14' "
         "noenhanced\n"
         "set border 3 linecolor rgb '#555555'\nset tics nomirror\n"
         "set grid linecolor rgb '#e4e4e4'\n"
         "set key outside above center horizontal Left reverse samplen 2\n"
      << "set xlabel " << gnuplot_quoted(plot.x_label) << "\nset ylabel "
      << gnuplot_quoted(plot.y_label) << "\n";
  if (plot.log_x) out << "set logscale x 2\nset format x '%g'\n";
  if (plot.log_y) out << "set logscale y\nset format y '%g'\n";
  write_range(out, 'x', plot.x_range);
  write_range(out, 'y', plot.y_range);
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    out << "$series" << i << " << EOD\n";
    for (const auto& [x, y] : plot.series[i].points) {
      const bool can_be_shown = (!plot.log_x || x > 0.0) && (!plot.log_y || y > 0.0);
      if (can_be_shown) out << x << ' ' << y << '\n';
    }
    out << "EOD\n";
  }
  out << "plot ";
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const Series& series = plot.series[i];
    out << (i == 0 ? "" : ", \\\n  ") << "$series" << i << " with " << style_of(series)
        << " linecolor rgb '" << series.color << "' linewidth 1.5 dashtype "
        << (series.dashed ? 2 : 1) << " title " << gnuplot_quoted(series.name);
  }
  out << "\n";
  return out.str();
}

std::optional<std::string> gnuplot_version() {
  auto version = output_of("gnuplot --version 2>/dev/null");
  if (version && !version->empty() && version->back() == '\n') version->pop_back();
  return version;
}

std::string run_gnuplot(const std::filesystem::path& script_path) {
  const auto output = output_of("gnuplot " + shell_quoted(script_path.string()));
  if (!output) throw std::runtime_error("gnuplot failed on " + script_path.string());
  return *output;
}

}  // namespace kintsugi::segmenter
