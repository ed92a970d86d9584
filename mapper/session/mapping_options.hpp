#pragma once

#include "mapper/process/options.hpp"
#include "mapper/session/stored_sessions.hpp"

namespace kintsugi::mapper {

inline constexpr char kMapNameOption[] = "--map-name";

/// Those of the options on which the slices depend.
MappingOptions mapping_options(const Options& options);

/// @throws std::runtime_error naming every option in which the two differ
void expect_same_options(const MappingOptions& now, const MappingOptions& then);

}  // namespace kintsugi::mapper
