#pragma once
// kintsugi-evaluate --trajectory: the errors of an estimated camera path.

#include <filesystem>
#include <string>

#include "segmenter/evaluation/trajectory/relative_trajectory_error.hpp"

namespace CLI {
class App;
}

namespace kintsugi::segmenter {

struct TrajectoryOptions {
  std::string estimate_file;  ///< TUM format; empty: this task is not asked for
  std::string truth_file;     ///< TUM format
  RelativeTrajectoryErrorConfig relative;
  std::filesystem::path csv_file;   ///< empty: none
  std::filesystem::path json_file;  ///< empty: none; also of --live
};

void add_trajectory_options(CLI::App& app, TrajectoryOptions& options);

/// Prints the errors on stdout and writes the files asked for.
/// @throws std::runtime_error for a file that cannot be read or written, std::invalid_argument when
///   there are too few pairs or the configuration is not valid
void evaluate_trajectory(const TrajectoryOptions& options);

}  // namespace kintsugi::segmenter
