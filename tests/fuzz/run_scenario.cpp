#include "tests/fuzz/run_scenario.hpp"

#include <exception>

#include "segmenter/core/make_engine.hpp"
#include "tests/fuzz/changing_cloud.hpp"
#include "tests/fuzz/engine_check.hpp"

namespace kintsugi::segmenter::fuzz {

EngineFactory engine_factory(const std::string& mode) {
  return [mode](const PointCloud& cloud, const EngineConfig& config) {
    // Large parts of small clouds change: without this, mode `exact` would always rebuild its
    // state.
    EngineConfig incremental = config;
    incremental.rebuild_share = 1e9;
    return make_engine(mode, cloud, incremental);
  };
}

Outcome run_scenario(const Scenario& scenario, const EngineFactory& make_engine) {
  ChangingCloud map(scenario);
  const auto engine = make_engine(map.cloud(), scenario.config);
  EngineCheck check(*engine, map.cloud(), scenario.config);
  Outcome outcome;
  for (const Step& step : scenario.steps) {
    ++outcome.num_steps;
    try {
      const CloudChange change = map.apply(step);
      outcome.num_rebuilt += engine->update(change).is_rebuilt;
      outcome.failure = check(change, map.live());
    } catch (const std::exception& error) {
      outcome.failure = std::string("threw: ") + error.what();
    }
    if (outcome.failure) break;
  }
  return outcome;
}

}  // namespace kintsugi::segmenter::fuzz
