#pragma once
// The base of a log: a first file that has replaced some others, by what is still needed of them.

#include <cstdint>
#include <filesystem>

#include "lcmtypes/codec/codec.hpp"

namespace kintsugi::mapper {

/// Channel of the first event of a base, in the log only.
inline constexpr char kBaseChannel[] = "MAPPER_LOG_BASE";

/// The data of that event: the number of the file with which the log goes on.
Bytes base_before(std::int32_t next_number);

/// The number of the file that follows the first one at `path`: 1 unless it is a base.
/// @throws std::runtime_error naming the file when it cannot be read, or says nothing sensible
std::int32_t next_after_base(const std::filesystem::path& path);

}  // namespace kintsugi::mapper
