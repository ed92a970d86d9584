#include "segmenter/process/options.hpp"

#include <array>
#include <map>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "segmenter/core/presets.hpp"

namespace kintsugi::segmenter {
namespace {

/// A value that a preset sets.
struct Parameter {
  const char* option;
  double EngineConfig::*field;
  const char* help;
};
constexpr std::array<Parameter, 5> kParameters = {{
    {"--threshold", &EngineConfig::threshold, "T: join threshold of a single point, > 0"},
    {"--scale", &EngineConfig::scale, "k: bias towards large segments, > 0"},
    {"--color-weight", &EngineConfig::color_weight,
     "lambda: an edge weighs this times the squared distance of its colours (RGB from 0 to 1) "
     "more, >= 0; 0: only normals count"},
    {"--min-points", &EngineConfig::min_points,
     "segments of fewer points are joined to a neighbour; told for points 1 cm apart, elsewhere it "
     "is the same area; >= 0; 0: none are"},
    {"--radius-factor", &EngineConfig::radius_factor,
     "neighbours are closer than this times the resolution, > 0"},
}};

/// Values that were given by themselves stay. Those that were not tell --print-config the preset's.
void apply_preset(const std::string& name, CLI::App& app, EngineConfig& engine) {
  const EngineConfig chosen = preset(name);
  for (const Parameter& parameter : kParameters) {
    CLI::Option* const option = app.get_option(parameter.option);
    if (!option->empty()) continue;
    engine.*parameter.field = chosen.*parameter.field;
    option->capture_default_str();
  }
}

void add_preset_options(CLI::App& app, EngineConfig& engine, std::string_view default_preset) {
  app.add_option_function<std::string>(
         "--preset", [&app, &engine](const std::string& name) { apply_preset(name, app, engine); },
         "the values of the next five: objects, so that things come out whole; or paper, those of "
         "Finman et al.")
      ->check(CLI::IsMember(std::vector<std::string>(preset_names().begin(), preset_names().end())))
      ->default_str(std::string(default_preset));
  for (const Parameter& parameter : kParameters) {
    app.add_option(parameter.option, engine.*parameter.field, parameter.help);
  }
  apply_preset(std::string(default_preset), app, engine);
}

}  // namespace

void add_segmentation_options(CLI::App& app, SegmentMapConfig& config,
                              std::string_view default_preset) {
  const std::map<std::string, NeighbourSearch> searches{{"grid", NeighbourSearch::kGrid},
                                                        {"flann", NeighbourSearch::kFlann}};
  EngineConfig& engine = config.engine;
  app.add_option(
         "--mode", config.mode,
         "exact: what batch gives, for the cost of what a slice changes; batch: Algorithm 1 "
         "over the whole map for each slice; voting: Algorithms 2-5, near to batch")
      ->capture_default_str();
  app.add_flag("--audit", engine.audit,
               "mode exact: compare it with batch after each slice, segments and their join "
               "thresholds to the bit, and end at the first difference; as slow as batch");
  add_preset_options(app, engine, default_preset);
  app.add_option("--beta", engine.beta, "of Eq. 4, in (0, 1); mode voting")->capture_default_str();
  app.add_option("--neighbours", engine.neighbour_search, "neighbour search: grid or flann")
      ->transform(CLI::CheckedTransformer(searches).description("{grid,flann}"))
      ->default_str("grid");
}

}  // namespace kintsugi::segmenter
