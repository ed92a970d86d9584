#pragma once

#include <cstdint>
#include <string>

#include "segmenter/core/engine/engine.hpp"
#include "segmenter/core/parameters/engine_config.hpp"
#include "tests/bench/map_generator_file.hpp"

namespace kintsugi::segmenter::bench {

struct CorrectionsConfig {
  std::size_t num_single = 1000;  ///< number of corrections of one point
  std::uint64_t seed = 3;
  bool measures_cpu = false;  ///< CPU time of all threads instead of wall time
};

/// Corrects a finished map, and prints the times of the engine as a Markdown table: single points
/// get another normal one by one, a tenth as many are removed, balls of growing radius are rotated
/// and lifted, a third of the map is moved by 2 cm and back. Then it segments the final points with
/// batch, and returns whether labels and thetas are the same.
bool bench_corrections(const std::string& mode, const EngineConfig& config, const Slices& slices,
                       const CorrectionsConfig& corrections);

}  // namespace kintsugi::segmenter::bench
