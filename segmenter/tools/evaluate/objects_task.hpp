#pragma once
// kintsugi-evaluate --changes and --objects: what was told of objects, against the truth.

#include <filesystem>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace kintsugi::segmenter {

struct ObjectsOptions {
  std::string changes_folder;   ///< of kintsugi-diff; empty: this task is not asked for
  std::string detections_file;  ///< of kintsugi-objects detect; likewise
  std::string objects_truth_file;
  std::string before_truth_file;
  std::string after_truth_file;
  std::vector<std::string> taught;
  std::string library;
  std::string map_file;   ///< in which was detected; empty: no reasons and no pictures
  std::string times_log;  ///< of a live run; empty: this task is not asked for
};

void add_objects_options(CLI::App& app, ObjectsOptions& options);

/// Prints how soon detections were told in a live run; returns the exit status.
/// @throws std::runtime_error naming a file that cannot be read or written
int evaluate_detection_times(const std::filesystem::path& log,
                             const std::filesystem::path& json_file);

/// Prints the scores on stdout; writes the report into `folder` unless that is empty.
/// @throws std::runtime_error naming a file that cannot be read or written
void evaluate_objects(const ObjectsOptions& options, const std::filesystem::path& folder);

}  // namespace kintsugi::segmenter
