#pragma once
// Marks in a durable log (kMarkChannel), and what the end of a log says about who left it so.

#include <cstdint>
#include <filesystem>
#include <string>

#include "lcmtypes/log/log_reader.hpp"

namespace kintsugi::mapper {

/// The data of a mark whose event begins at byte `position` of its file: by it a mark is known from
/// bytes that look like one.
Bytes mark_at(std::int64_t position);

/// @throws std::runtime_error unless `event` is the mark of this position
void check_mark(const LogEvent& event, std::int64_t position);

/// Whether another event begins behind `position`: then what is there was not left by an
/// interrupted write.
bool has_event_behind(const std::filesystem::path& path, std::int64_t position);

/// Whether there is a mark behind `position`: then what is there was not left by a power cut.
bool has_mark_behind(const std::filesystem::path& path, std::int64_t position);

}  // namespace kintsugi::mapper
