#pragma once

#include <filesystem>
#include <vector>

#include "mapper/openni2_driver/formats/recording_contents.hpp"

namespace kintsugi::mapper {

/// Images in files of their own: depth as 16-bit PNG or OpenEXR (metres), colour as PNG or JPEG.
class ImageFiles : public ImageStore {
 public:
  struct Files {
    std::vector<std::filesystem::path> depth;
    std::vector<std::filesystem::path> color;
    /// 8-bit PNG for each depth image, in which 0 means that its depth is a guess: it becomes
    /// invalid. Empty: there are none.
    std::vector<std::filesystem::path> confidence;
  };

  ImageFiles(Files files, cv::Size depth_size, cv::Size color_size);

  [[nodiscard]] cv::Mat depth(int index) override;
  [[nodiscard]] cv::Mat_<cv::Vec3b> color(int index) override;
  [[nodiscard]] bool depth_is_missing(int index) const override;
  [[nodiscard]] bool color_is_missing(int index) const override;

 private:
  Files files_;
  cv::Size depth_size_;
  cv::Size color_size_;
};

/// Size of the first image of a list that can be told; the others are expected to have it.
/// @throws std::runtime_error naming the first file and what is wrong with it when none can be read
cv::Size size_of_images(const std::vector<std::filesystem::path>& files);

}  // namespace kintsugi::mapper
