#pragma once

#include "mapper/process/options.hpp"

namespace kintsugi::mapper {

/// kintsugi-mapper: maps a new session, continues one that was interrupted, or serves one that has
/// ended, until it has answered everybody.
/// @throws std::exception with what went wrong; what could be done is done then
void run_mapper(const Options& options);

}  // namespace kintsugi::mapper
