#pragma once
// Recordings in single files. For each format: whether a file is one, by its first bytes, and the
// reader, which goes through the whole file but decodes no more than the first image.
//
// Readers throw std::runtime_error naming the file, the byte or the image, and what was expected. A
// file that is cut off ends before the image that is not complete, with a remark.

#include <filesystem>
#include <string>

#include "mapper/openni2_driver/formats/recording_contents.hpp"

namespace kintsugi::mapper {

/// The log of Kintinuous and ElasticFusion. Depth is in millimetres. It has no camera: that of
/// FILE.camera.txt is taken, or else the two programs' default.
bool is_klg_file(const std::filesystem::path& file);
/// @param swap_colors red and blue change places: some converters write blue first
RecordingContents read_klg_file(const std::filesystem::path& file, bool swap_colors);

/// ScanNet's sensor stream, version 4.
bool is_sens_file(const std::filesystem::path& file);
RecordingContents read_sens_file(const std::filesystem::path& file);

/// Topics of a ROS bag; empty: guessed.
struct BagTopics {
  std::string depth;
  std::string color;
};

/// A bag of ROS 1, also of the RealSense SDK.
bool is_ros_bag(const std::filesystem::path& file);
RecordingContents read_ros_bag(const std::filesystem::path& file, const BagTopics& topics);

}  // namespace kintsugi::mapper
