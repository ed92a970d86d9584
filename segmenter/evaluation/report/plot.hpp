#pragma once
// Line plots, drawn by gnuplot.

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace kintsugi::segmenter {

struct Series {
  enum class Style { kLine, kLinesAndPoints, kSteps };

  std::string name;   ///< in the legend
  std::string color;  ///< "#rrggbb"
  Style style = Style::kLine;
  bool dashed = false;
  std::vector<std::pair<double, double>> points{};
};

/// Series are drawn in order, later ones on top. The legend stands above the curves.
struct Plot {
  std::string x_label;  ///< with its unit
  std::string y_label;
  bool log_x = false;
  bool log_y = false;
  std::optional<std::pair<double, double>> x_range{};
  std::optional<std::pair<double, double>> y_range{};
  std::vector<Series> series{};
};

/// At most `2 * num_buckets` of the points that look the same: the lowest and highest of each
/// bucket of consecutive ones.
std::vector<std::pair<double, double>> thinned(const std::vector<std::pair<double, double>>& points,
                                               std::size_t num_buckets);

/// A self-contained gnuplot script that prints the plot as SVG. Values that a logarithmic axis
/// cannot show are left out.
std::string to_gnuplot(const Plot& plot);

/// The version line of the installed gnuplot; nothing when there is none.
std::optional<std::string> gnuplot_version();

/// What gnuplot prints for the script in `script_path`.
/// @throws std::runtime_error when it cannot be run, or fails
std::string run_gnuplot(const std::filesystem::path& script_path);

}  // namespace kintsugi::segmenter
