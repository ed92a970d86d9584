#pragma once

#include "mapper/process/option_table.hpp"

namespace kintsugi::mapper {

/// Before a run, and not when it has ended.
/// @throws std::runtime_error naming the flags of one file that is written twice, or also read, and
///   a file whose folder does not exist, or that is a folder itself
void check_output_files(const Options& options);

/// Says which files are asked for and not there, since a session that is complete is not mapped
/// again.
void warn_of_missing_files(const Options& options);

}  // namespace kintsugi::mapper
