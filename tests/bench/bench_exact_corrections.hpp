#pragma once

#include <cstdint>
#include <string>

#include "segmenter/core/engine/engine.hpp"
#include "segmenter/core/parameters/engine_config.hpp"
#include "tests/bench/map_generator_file.hpp"

namespace kintsugi::segmenter::bench {

struct CorrectionsConfig {
  std::size_t num_single = 1000;  ///< updates of one point
  std::uint64_t seed = 3;
  bool measures_cpu = false;  ///< CPU time of all threads for wall time: on a busy machine
};

/// Corrects a finished map in many ways, and prints the times of the engine as a Markdown table:
/// single points get another normal one by one, a tenth as many leave, balls of growing
/// radius turn and shift, a third of the map moves by 2 cm and back. At the end labels and thetas
/// must equal batch, whose time for the same points comes with it; returns whether they do.
bool bench_corrections(const std::string& mode, const EngineConfig& config, const Slices& slices,
                       const CorrectionsConfig& corrections);

}  // namespace kintsugi::segmenter::bench
