#pragma once

#include "segmenter/process/options.hpp"

namespace kintsugi::segmenter {

/// Sets up logging and runs the segmenter until it ends; returns its exit status.
/// @throws std::exception with a message for the user when it cannot begin or go on
int run(const Options& options);

}  // namespace kintsugi::segmenter
