#pragma once

#include <filesystem>
#include <string>

#include "segmenter/core/engine/engine.hpp"
#include "segmenter/core/parameters/engine_config.hpp"
#include "tests/bench/map_generator_file.hpp"

namespace kintsugi::segmenter::bench {

/// Takes a map slice by slice through an engine, segment ids and statistics, and prints time and
/// memory as Markdown tables. With `csv` not empty, each slice is a line of that file.
void bench_slices(const std::string& mode, const EngineConfig& config, const Slices& slices,
                  const std::filesystem::path& csv);

/// Segments the whole map at once, several times, as when a map is resumed, and prints time and
/// memory.
void bench_whole(const std::string& mode, const EngineConfig& config, const Slices& slices);

}  // namespace kintsugi::segmenter::bench
