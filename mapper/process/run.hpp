#pragma once

#include "mapper/process/options.hpp"

namespace kintsugi::mapper {

/// Maps the frames of a device, or only resends a session that has ended, as `options` say.
/// @throws std::exception with a message for the user when the run failed
void run(const Options& options);

}  // namespace kintsugi::mapper
