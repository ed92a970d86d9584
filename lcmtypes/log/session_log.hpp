#pragma once
// The log of a mapper (--store NAME.lcm), which may go on in further files: NAME.1.lcm and so on.

#include <cstdint>
#include <filesystem>
#include <vector>

#include "lcmtypes/codec/codec.hpp"

namespace kintsugi {

// Channels of events that are in the log only. A log that is not empty, and each session in it,
// begins with one of them.

/// The first event of a session: its number and its options as JSON.
inline constexpr char kOptionsChannel[] = "MAPPER_OPTIONS";
/// The first event of a base: a first file that has replaced some others, by what is still needed
/// of them.
inline constexpr char kBaseChannel[] = "MAPPER_LOG_BASE";
/// A mark: all before it in its file, and all files before, were on the disk when it was written.
inline constexpr char kMarkChannel[] = "MAPPER_LOG_MARK";

/// NAME.lcm for 0, NAME.2.lcm for 2.
std::filesystem::path numbered(const std::filesystem::path& path, int number);

/// The largest number that a file of the log NAME.lcm bears; 0: there is only the first, or none.
int last_number(const std::filesystem::path& path);

/// The numbers of the files that belong to a log, in the order in which they were written. What a
/// base has replaced does not: its mapper was killed before it could remove that.
/// @throws std::runtime_error naming the file when one is missing or the base is damaged
std::vector<int> numbers_of_files(const std::filesystem::path& path);

/// The data of the event on kBaseChannel: the number of the file with which the log goes on.
Bytes base_before(std::int32_t next_number);

/// The number of the file that follows the first one at `path`: 1 unless it is a base.
/// @throws std::runtime_error naming the file when it cannot be read, or says nothing sensible
std::int32_t next_after_base(const std::filesystem::path& path);

/// Whether a mapper has written this file, and not lcm-logger.
/// @throws std::runtime_error as LogReader
bool is_session_log(const std::filesystem::path& path);

}  // namespace kintsugi
