#pragma once

#include <map>
#include <string>

namespace kintsugi::mapper {

/// The options on which the slices of a session depend: name of the flag and its value. Sessions
/// with equal options make the same slices of the same frames.
using MappingOptions = std::map<std::string, std::string>;

/// The option that names the map; earlier sessions in a log are published under this name.
inline constexpr char kMapNameOption[] = "--map-name";

/// @throws std::runtime_error naming every option in which the two differ, and both values
void expect_same_options(const MappingOptions& now, const MappingOptions& then);

}  // namespace kintsugi::mapper
