#include "mapper/process/output_files.hpp"

#include <filesystem>
#include <vector>

#include "lcmtypes/base/logger.hpp"
#include "lcmtypes/base/output_files.hpp"

namespace kintsugi::mapper {
namespace {

namespace fs = std::filesystem;

/// Without those that are not asked for.
std::vector<NamedFile> given(std::vector<NamedFile> files) {
  std::erase_if(files, [](const NamedFile& file) { return file.path.empty(); });
  return files;
}

std::vector<NamedFile> files_of_map(const Options& options) {
  return given({{"--cloud", options.cloud_file},
                {"--mesh", options.mesh_file},
                {"--output-trajectory", options.output_path_file},
                {"--online-trajectory", options.online_path_file},
                {"--timings", options.timings_file}});
}

std::vector<NamedFile> output_files(const Options& options) {
  std::vector<NamedFile> files = files_of_map(options);
  if (!options.resume_file.empty()) {
    files.push_back({"--resume", options.resume_file});
  } else if (!options.store_file.empty()) {
    files.push_back({"--store", options.store_file});
  }
  return files;
}

}  // namespace

void check_output_files(const Options& options) {
  const std::vector<NamedFile> written = output_files(options);
  for (const NamedFile& file : written) check_folder_of(file.path);
  check_different({{"--trajectory", options.given_path_file},
                   {"--calibration", options.source.calibration_file}},
                  written);
}

void warn_of_missing_files(const Options& options) {
  for (const auto& [name, path] : files_of_map(options)) {
    if (fs::exists(path)) continue;
    spdlog::warn("{} '{}' is not written: the session is complete and is not mapped again", name,
                 path.string());
  }
}

}  // namespace kintsugi::mapper
