#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include <opencv2/core.hpp>

#include "viewer/output/attempts.hpp"

namespace kintsugi::viewer {

/// Writes pictures into a folder, each complete or not at all.
class PictureFolder {
 public:
  explicit PictureFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// False when it could not be written; logged at the first of several failures.
  bool save(const std::string& name, const cv::Mat3b& picture);

  /// Removes a picture, if it is there.
  void remove(const std::string& name);

  std::int64_t written() const { return written_; }
  /// Why the last picture could not be written; empty when it was.
  const std::string& problem() const { return attempts_.problem(); }

 private:
  std::filesystem::path folder_;
  Attempts attempts_;
  std::int64_t written_ = 0;
};

}  // namespace kintsugi::viewer
