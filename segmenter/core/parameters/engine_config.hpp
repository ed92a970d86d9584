#pragma once
// The parameters of the segmentation: their values, and one table that describes them.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "segmenter/core/graph/edge_weight.hpp"
#include "segmenter/core/graph/neighbour_index.hpp"

namespace kintsugi::segmenter {

/// The values; the defaults are the paper's. kMapParameters and kSpeedParameters describe each
/// double.
struct EngineConfig {
  double threshold = 0.001;    ///< T
  double scale = 0.0005;       ///< k
  double color_weight = 0.0;   ///< lambda
  double min_points = 0.0;     ///< fragments have fewer points, at a resolution of 1 cm
  double beta = 0.85;          ///< beta of Eq. 4
  double resolution_m = 0.01;  ///< voxel size of the map
  double radius_factor = 2.0;  ///< r / resolution_m

  double rebuild_share = 0.4;
  double explore_share = 0.1;
  double explore_at_least = 20'000.0;

  /// Mode `exact`: compare every update with batch and throw AuditError at the first difference.
  bool audit = false;
  NeighbourSearch neighbour_search = NeighbourSearch::kGrid;  ///< each kind finds the same

  /// r, as the float32 that squared distances are compared with.
  float radius_m() const { return static_cast<float>(radius_factor * resolution_m); }
  EdgeWeight edge_weight() const { return {.color_weight = color_weight}; }
  /// T + k. No threshold theta exceeds it, so an edge of this weight or more never joins anything.
  double max_weight() const { return threshold + scale; }
  /// min_points at this resolution: segments of fewer points are fragments. 0: there are none.
  std::int64_t fragment_limit() const;

  /// @throws std::invalid_argument naming the parameter, its value and its bound
  void validate() const;
};

struct ParameterBound {
  bool (*holds)(double value);
  std::string_view text;
};

/// The description of a parameter. Checks, command-line options, files and the comparison on resume
/// loop over the tables below.
struct EngineParameter {
  std::string_view name;  ///< in messages and files
  double EngineConfig::*value;
  ParameterBound bound;
  std::string_view unit;  ///< empty: it has none
  std::string_view help;
  /// The value in the preset `objects`; nothing: the default, which is the preset `paper`.
  std::optional<double> objects = std::nullopt;
  bool comes_with_slices = false;  ///< set by the slices of a map, not by the user
};

/// The command-line option for a parameter: "--color-weight".
std::string option_name(const EngineParameter& parameter);

namespace bounds {
inline constexpr ParameterBound kPositive{
    [](double value) { return value > 0.0 && std::isfinite(value); }, "> 0 and finite"};
inline constexpr ParameterBound kNotNegative{
    [](double value) { return value >= 0.0 && std::isfinite(value); }, ">= 0 and finite"};
inline constexpr ParameterBound kProperShare{
    [](double value) { return value > 0.0 && value < 1.0; }, "in (0, 1)"};
}  // namespace bounds

/// The parameters that decide the partition. A saved map holds them in this order and is continued
/// only with the same values; segments.json lists them.
inline constexpr auto kMapParameters = std::to_array<EngineParameter>({
    {.name = "threshold",
     .value = &EngineConfig::threshold,
     .bound = bounds::kPositive,
     .unit = "",
     .help = "T: join threshold of a single point"},
    {.name = "scale",
     .value = &EngineConfig::scale,
     .bound = bounds::kPositive,
     .unit = "",
     .help = "k: the larger, the larger the segments",
     .objects = 0.002},
    {.name = "color_weight",
     .value = &EngineConfig::color_weight,
     .bound = bounds::kNotNegative,
     .unit = "",
     .help = "lambda: this times the squared distance of the two colours (RGB from 0 to 1) is "
             "added to the weight of an edge; 0: only normals count",
     .objects = 0.003},
    {.name = "min_points",
     .value = &EngineConfig::min_points,
     .bound = bounds::kNotNegative,
     .unit = "points",
     .help = "segments of fewer points are joined to a neighbour; for a resolution of 1 cm, at "
             "others it stands for the same area; 0: no segments are joined so",
     .objects = 50.0},
    {.name = "beta",
     .value = &EngineConfig::beta,
     .bound = bounds::kProperShare,
     .unit = "",
     .help = "beta of Eq. 4, used by mode voting"},
    {.name = "resolution_m",
     .value = &EngineConfig::resolution_m,
     .bound = bounds::kPositive,
     .unit = "m",
     .help = "voxel size of the map",
     .comes_with_slices = true},
    {.name = "radius_factor",
     .value = &EngineConfig::radius_factor,
     .bound = bounds::kPositive,
     .unit = "voxels",
     .help = "r: points closer than this are neighbours"},
});

/// The parameters that decide only how long an update takes: neither options nor saved.
inline constexpr auto kSpeedParameters = std::to_array<EngineParameter>({
    {.name = "rebuild_share",
     .value = &EngineConfig::rebuild_share,
     .bound = bounds::kNotNegative,
     .unit = "of the points",
     // Measured: a point that comes or goes costs 2 us, a point of a rebuild 1 us.
     .help = "mode exact rebuilds its state when more points come and go than this share of the "
             "map; a point that moves does both"},
    {.name = "explore_share",
     .value = &EngineConfig::explore_share,
     .bound = bounds::kNotNegative,
     .unit = "of the points",
     // Measured: a point that looks at its edges again costs 3 us. So this gives up when a third of
     // a rebuild is spent; patches cost a quarter less than with 0.04, and with 0.3 not less.
     .help = "mode exact also rebuilds its state when more points than this share of the map have "
             "to look at their edges again"},
    {.name = "explore_at_least",
     .value = &EngineConfig::explore_at_least,
     .bound = bounds::kNotNegative,
     .unit = "points",
     .help = "as long as no more points than this have to, explore_share does not count"},
});

// A field without a row would be neither checked nor saved.
static_assert(sizeof(EngineConfig) ==
                  (kMapParameters.size() + kSpeedParameters.size()) * sizeof(double) +
                      2 * sizeof(NeighbourSearch),
              "every double of EngineConfig needs its row in one of the tables");

}  // namespace kintsugi::segmenter
