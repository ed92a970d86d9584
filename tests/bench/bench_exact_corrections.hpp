#pragma once

#include <cstdint>
#include <string>

#include "segmenter/core/engine.hpp"
#include "tests/bench/map_generator_file.hpp"

namespace kintsugi::segmenter::bench {

/// Corrects a finished map in many ways, and prints the times of the engine as a Markdown table:
/// `num_single` points get another normal one by one, a tenth as many leave, balls of growing
/// radius turn and shift, a third of the map moves by 2 cm and back. At the end labels and thetas
/// must equal batch, whose time for the same points comes with it; returns whether they do.
bool bench_corrections(const std::string& mode, const EngineConfig& config, const Slices& slices,
                       std::size_t num_single, std::uint64_t seed);

}  // namespace kintsugi::segmenter::bench
