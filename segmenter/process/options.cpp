#include "segmenter/process/options.hpp"

#include <map>
#include <string>
#include <vector>

#include <spdlog/fmt/fmt.h>

#include "segmenter/core/parameters/presets.hpp"

namespace kintsugi::segmenter {
namespace {

template <class Fn>
void for_each_option(const Fn& fn) {
  for (const EngineParameter& parameter : kMapParameters) {
    if (!parameter.comes_with_slices) fn(parameter);
  }
}

/// Sets the options that were not given by themselves, and what --print-config shows for them.
void apply_preset(const std::string& name, CLI::App& app, EngineConfig& engine) {
  const EngineConfig chosen = preset(name);
  for_each_option([&](const EngineParameter& parameter) {
    CLI::Option* const option = app.get_option(option_name(parameter));
    if (!option->empty()) return;
    engine.*parameter.value = chosen.*parameter.value;
    option->capture_default_str();
  });
}

std::string help_of(const EngineParameter& parameter) {
  const std::string unit = parameter.unit.empty() ? "" : fmt::format(" ({})", parameter.unit);
  return fmt::format("{}{}; {}", parameter.help, unit, parameter.bound.text);
}

void add_parameter_options(CLI::App& app, EngineConfig& engine, std::string_view default_preset) {
  app.add_option_function<std::string>(
         "--preset", [&app, &engine](const std::string& name) { apply_preset(name, app, engine); },
         "values for the parameters that are not given: objects, so that objects come out whole, "
         "or paper, those of Finman et al.")
      ->check(CLI::IsMember(std::vector<std::string>(preset_names().begin(), preset_names().end())))
      ->default_str(std::string(default_preset));
  for_each_option([&](const EngineParameter& parameter) {
    app.add_option(option_name(parameter), engine.*parameter.value, help_of(parameter));
  });
  apply_preset(std::string(default_preset), app, engine);
}

}  // namespace

void add_segmentation_options(CLI::App& app, SegmentMapConfig& config,
                              std::string_view default_preset) {
  std::map<std::string, NeighbourSearch> searches;
  for (const NeighbourSearch search : {NeighbourSearch::kGrid, NeighbourSearch::kFlann}) {
    searches.emplace(name_of(search), search);
  }
  EngineConfig& engine = config.engine;
  app.add_option(
         "--mode", config.mode,
         "exact: the result of batch, at a cost that depends on what a slice changes; batch: "
         "Algorithm 1 over the whole map for each slice; voting: Algorithms 2-5, close to batch")
      ->capture_default_str();
  app.add_flag("--audit", engine.audit,
               "mode exact: compare it with batch after each slice, segments and join thresholds "
               "to the bit, and stop at the first difference; as slow as batch");
  add_parameter_options(app, engine, default_preset);
  app.add_option("--neighbours", engine.neighbour_search, "neighbour search: grid or flann")
      ->transform(CLI::CheckedTransformer(searches).description("{grid,flann}"))
      ->default_str(std::string(name_of(NeighbourSearch::kGrid)));
}

}  // namespace kintsugi::segmenter
