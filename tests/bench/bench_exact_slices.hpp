#pragma once

#include <filesystem>
#include <string>

#include "segmenter/core/engine/engine.hpp"
#include "segmenter/core/parameters/engine_config.hpp"
#include "tests/bench/map_generator_file.hpp"

namespace kintsugi::segmenter::bench {

/// Segments a map slice by slice with segment ids and statistics, and prints time and memory as
/// Markdown tables. If `csv` is not empty, writes the times of each slice to this file.
void bench_slices(const std::string& mode, const EngineConfig& config, const Slices& slices,
                  const std::filesystem::path& csv);

/// Segments the whole map at once, as when a map is resumed, and prints the median time of three
/// runs, and the memory.
void bench_whole(const std::string& mode, const EngineConfig& config, const Slices& slices);

}  // namespace kintsugi::segmenter::bench
